// SPDX-License-Identifier: Apache-2.0
// `ablation`: what each mechanism and each key is worth. One thing is changed a row, on the worlds of `unseen` and in
// drives in which the robot is carried elsewhere, and compared with the delivered settings world by world.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <limits>
#include <map>
#include <string>

#include "experiments/drive/first_map.hpp"
#include "experiments/mapping/ablation_changes.hpp"
#include "experiments/mapping/gate_run.hpp"
#include "experiments/mapping/unseen_drive.hpp"
#include "experiments/registry.hpp"
#include "experiments/seed_summary.hpp"

namespace deltamap::experiments {
namespace {

constexpr int kWorlds = 12;
constexpr int kQuickWorlds = 1;
constexpr double kMinutes = 5.0;
constexpr double kQuickMinutes = 1.0;
constexpr std::size_t kQuickStep = 10;                 // one change of so many
constexpr const char* kCarriedPlace = "changed.yaml";  // a hall that is half out of date: what is wrong, map or pose?
constexpr int kCarriedSeeds = 2;                       // of each event

constexpr const char* kDelivered = "delivered";
constexpr double kSame = 1e-9;  // relative; closer values are equal

struct MainFigure {
  const char* number;
  Better better;
};
constexpr std::array kMainFigures{MainFigure{"error_rms_m", Better::kLess},
                                  MainFigure{"jumps", Better::kLess},
                                  MainFigure{"off_share", Better::kLess},
                                  MainFigure{"recall", Better::kMore},
                                  MainFigure{"precision", Better::kMore},
                                  MainFigure{"skill", Better::kMore},
                                  MainFigure{"gate_shut_while_right", Better::kLess},
                                  MainFigure{"carried_wrong_s", Better::kLess},
                                  MainFigure{"carried_cells_astray", Better::kLess},
                                  MainFigure{"carried_shut", Better::kLess}};
constexpr auto kNotMeasured = std::numeric_limits<double>::quiet_NaN();

/// What a change did to one figure in the worlds that both have measured.
struct Paired {
  std::vector<double> differences;  ///< with the change, less as delivered
  int better = 0;
  int worse = 0;
};

struct Row {
  std::string change;
  std::string what;
  std::vector<Paired> figures;  ///< in the order of kMainFigures

  [[nodiscard]] bool moves_nothing() const {
    return std::all_of(figures.begin(), figures.end(), [](const Paired& one) { return one.better + one.worse == 0; });
  }
};

bool is_clear(const Certainty& certainty) {
  return certainty.has_interval() && (certainty.low > 0.0 || certainty.high < 0.0);
}

std::string three_digits(double value) {
  char text[32];
  (void)std::snprintf(text, sizeof text, "%+.3g", value);
  return value == 0.0 ? "0" : text;
}

/// "+0.01 [-0.02, +0.04] 3:5"; `**` around it where the interval leaves out 0.
std::string text_of(const Paired& paired) {
  if (paired.differences.empty()) return "";
  if (paired.better + paired.worse == 0) return "0";
  const Certainty certainty = certainty_of_mean(paired.differences);
  std::string text = three_digits(mean_of(paired.differences));
  if (certainty.has_interval()) text += " [" + three_digits(certainty.low) + ", " + three_digits(certainty.high) + "]";
  text += " " + std::to_string(paired.better) + ":" + std::to_string(paired.worse);
  return is_clear(certainty) ? "**" + text + "**" : text;
}

Paired paired_of(const MainFigure& figure, const std::vector<const Outcome*>& changed,
                 const std::vector<const Outcome*>& delivered) {
  Paired paired;
  for (const Outcome* with : changed) {
    const auto same_world = std::find_if(delivered.begin(), delivered.end(),
                                         [&](const Outcome* one) { return one->label("seed") == with->label("seed"); });
    if (same_world == delivered.end()) continue;
    const double before = (*same_world)->number(figure.number);
    const double after = with->number(figure.number);
    if (std::isnan(before) || std::isnan(after)) continue;
    const bool is_same = std::abs(after - before) <= kSame * std::max(std::abs(before), std::abs(after));
    paired.differences.push_back(is_same ? 0.0 : after - before);
    if (is_same) continue;
    (after < before) == (figure.better == Better::kLess) ? ++paired.better : ++paired.worse;
  }
  return paired;
}

std::vector<Row> rows_of(const std::vector<Outcome>& outcomes) {
  std::vector<std::pair<std::string, std::vector<const Outcome*>>> groups;
  for (const Outcome& outcome : outcomes) {
    if (groups.empty() || groups.back().first != outcome.label("change"))
      groups.push_back({outcome.label("change"), {}});
    groups.back().second.push_back(&outcome);
  }
  std::vector<Row> rows;
  for (const auto& [change, changed] : groups) {
    if (change == kDelivered) continue;
    rows.push_back({change, changed.front()->label("what"), {}});
    for (const MainFigure& figure : kMainFigures)
      rows.back().figures.push_back(paired_of(figure, changed, groups.front().second));
  }
  return rows;
}

TextTable table_of(const std::string& title, const std::vector<Row>& rows, bool switches) {
  TextTable table{title, {"change", "what"}, {}};
  for (const MainFigure& figure : kMainFigures) table.columns.emplace_back(figure.number);
  for (const Row& row : rows) {
    if ((row.change.starts_with("off-") || row.change.starts_with("on-")) != switches) continue;
    table.rows.push_back({row.change, row.what});
    for (const Paired& paired : row.figures) table.rows.back().push_back(text_of(paired));
  }
  return table;
}

/// How far the changes move the error, in order.
Chart chart_of(const std::vector<Row>& rows) {
  std::vector<double> values;
  for (const Row& row : rows) values.push_back(mean_of(row.figures.front().differences));
  std::sort(values.begin(), values.end());
  Series series{kMainFigures.front().number, {}};
  for (std::size_t i = 0; i < values.size(); ++i) series.points.emplace_back(static_cast<double>(i + 1), values[i]);
  return {
      "RMSE of the pose, difference to the delivered settings, m", "changes in order", "mean difference, m", {series}};
}

/// One outcome of any drive: what was changed, and every main figure, NaN where this drive does not measure it.
Outcome in_one_shape(const AblationChange& change, const std::string& seed, double minutes,
                     const std::map<std::string, double>& measured) {
  Outcome outcome{{{"change", change.name}, {"what", change.what}, {"seed", seed}}, {{"minutes", minutes}}, {}};
  for (const MainFigure& figure : kMainFigures) {
    const auto found = measured.find(figure.number);
    outcome.numbers.emplace_back(figure.number, found == measured.end() ? kNotMeasured : found->second);
  }
  return outcome;
}

Run unseen_of(const AblationChange& change, std::uint64_t seed, double minutes, const daemon::Settings& delivered) {
  const auto work = [=] {
    daemon::Settings settings = delivered;
    change.apply(settings);
    const Outcome drive = unseen_drive(seed, minutes, settings.localizer, settings.mapping);
    return in_one_shape(change, std::to_string(seed), minutes, {drive.numbers.begin(), drive.numbers.end()});
  };
  return {change.name + "-seed" + std::to_string(seed), work, change.name == kDelivered};
}

/// A drive of `gate` in which the robot is carried elsewhere.
Run carried_of(const AblationChange& change, PoseEvent event, std::uint64_t seed, double minutes,
               const simulation::Scenario& place, const daemon::Settings& delivered) {
  const std::string which = std::string{name_of(event)} + std::to_string(seed);
  const auto work = [=] {
    GateRun run{place, delivered, event, seed};
    change.apply(run.settings);
    run.before_s = std::min(run.before_s, 30.0 * minutes);
    run.after_s = 60.0 * minutes - run.before_s;
    const Outcome drive = outcome_of(run);
    return in_one_shape(change, which, minutes,
                        {{"carried_wrong_s", drive.number("wrong_s")},
                         {"carried_cells_astray", drive.number("cells_astray")},
                         {"carried_shut", drive.number("shut_after")}});
  };
  return {change.name + "-" + which, work, change.name == kDelivered};
}

std::vector<Run> runs_of(const Options& options) {
  const auto worlds = static_cast<std::uint64_t>(options.repeats.value_or(options.quick ? kQuickWorlds : kWorlds));
  const double minutes = options.minutes.value_or(options.quick ? kQuickMinutes : kMinutes);
  expect_one_set(options.seed, options.seed + worlds - 1);
  daemon::Settings delivered;
  delivered.localizer = options.localizer;
  delivered.mapping = options.mapping;
  std::vector<AblationChange> changes{{kDelivered, "settings as delivered", [](daemon::Settings&) {}}};
  for (auto& change : switched_off(delivered)) changes.push_back(std::move(change));
  for (auto& change : halved_and_doubled(delivered)) changes.push_back(std::move(change));
  const auto place = scenario_of(options, kCarriedPlace);
  const auto carried = options.quick ? 1 : std::min<std::uint64_t>(kCarriedSeeds, worlds);
  std::vector<Run> runs;
  for (std::size_t i = 0; i < changes.size(); i += options.quick ? kQuickStep : 1) {
    for (std::uint64_t seed = options.seed; seed < options.seed + worlds; ++seed)
      runs.push_back(unseen_of(changes[i], seed, minutes, delivered));
    for (const PoseEvent event : {PoseEvent::kBay, PoseEvent::kSlip, PoseEvent::kElsewhere}) {
      for (std::uint64_t seed = options.seed; seed < options.seed + carried; ++seed)
        runs.push_back(carried_of(changes[i], event, seed, minutes, *place, delivered));
    }
  }
  return runs;
}

Report report_of(const std::vector<Outcome>& outcomes) {
  Report report;
  const std::vector<Row> rows = rows_of(outcomes);
  const auto drives = std::count_if(outcomes.begin(), outcomes.end(),
                                    [](const Outcome& one) { return one.label("change") == kDelivered; });
  const auto idle = std::count_if(rows.begin(), rows.end(), [](const Row& row) { return row.moves_nothing(); });
  report.figures.push_back({"drives of each change", static_cast<double>(drives)});
  report.figures.push_back({"minutes in each", outcomes.front().number("minutes")});
  report.figures.push_back({"changes", static_cast<double>(rows.size())});
  report.figures.push_back({"changes that move no figure in any drive", static_cast<double>(idle)});
  for (const MainFigure& figure : kMainFigures) {
    std::vector<double> values;
    for (const Outcome& one : outcomes) {
      if (one.label("change") == kDelivered) values.push_back(one.number(figure.number));
    }
    std::erase_if(values, [](double value) { return std::isnan(value); });
    report.figures.push_back({std::string{"as delivered: "} + figure.number + ", mean",
                              mean_of(values),
                              "",
                              {},
                              "",
                              certainty_of_mean(values)});
  }
  report.charts.push_back(chart_of(rows));
  report.tables.push_back(table_of("Mechanisms switched off", rows, true));
  report.tables.push_back(table_of("Keys at half and at twice their value", rows, false));
  return report;
}

}  // namespace

Experiment ablation_experiment() {
  return {.name = "ablation",
          .what =
              "What each mechanism and each key is worth: switched off, halved or doubled, on unseen's worlds and "
              "carried elsewhere",
          .runs = runs_of,
          .report = report_of,
          .times = Experiment::Times::kThread};
}

}  // namespace deltamap::experiments
