// SPDX-License-Identifier: Apache-2.0
// `unseen`: forty minutes in a world that nobody has tuned on. Every seed is another kind of building, map, laser,
// robot and life in it; what a choice is worth shows in the median and the tail of many seeds, never in one.
#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

#include "experiments/mapping/unseen_drive.hpp"
#include "experiments/registry.hpp"
#include "experiments/seed_summary.hpp"
#include "experiments/watch/pose_course.hpp"

namespace deltamap::experiments {
namespace {

constexpr int kSeeds = 60;
constexpr int kQuickSeeds = 3;
constexpr double kMinutes = 40.0;
constexpr double kQuickMinutes = 6.0;
constexpr std::size_t kShown = 6;  // of the worst seeds: trajectory and error
constexpr double kChartEvery_s = 5.0;

std::vector<SpreadAsked> asked() {
  return {{"error_rms_m", "m", Better::kLess, 0.01, 0.03, 0.10},
          {"laser_error_rms_m", "m"},
          {"error_most_m", "m"},
          {"off_share"},
          {"stretches_off"},
          {"jumps", "", Better::kLess, 0.0, 0.0, 0.0},
          {"found_after_s", "s"},
          {"wrong_before_found_s", "s"},
          {"searching_while_near_s", "s"},
          {"recall", "", Better::kMore, 0.98, {}, 0.9},
          {"precision", "", Better::kMore, 0.98, {}, 0.9},
          {"skill", "", Better::kMore, 0.92, {}, 0.7},
          {"gate_shut_while_right", "", Better::kLess, 0.02, {}, 0.15},
          {"cells_written_astray", "", Better::kLess, 0.0, 0.0, 0.0},
          {"wall_drift_m", "m", Better::kLess, {}, {}, 0.02},
          {"inside_95", "", Better::kMore, 0.90},
          {"inside_95_after_slip", "", Better::kMore, 0.90},
          {"localizer_cpu_ms", "ms a scan"},
          {"mapping_cpu_ms", "ms a scan"}};
}

/// What kept the gate shut longest while the pose was right.
std::string longest_shut_by(const Outcome& outcome) {
  const std::vector<std::string> whys = all_whys_shut();
  const auto shut_s = [&](const std::string& why) { return outcome.number(shut_number(why)); };
  return *std::ranges::max_element(whys, {}, shut_s);
}

/// Why a drive counts as failed; empty where it does not.
std::string failure_of(const Outcome& outcome) {
  std::string failure;
  const auto add = [&](bool failed, const std::string& what) {
    if (failed) failure += (failure.empty() ? "" : ", ") + what;
  };
  add(outcome.number("start_found") == 0.0, "start not found");
  add(outcome.number("stretches_off") > 0.0, "off for " + text_of(outcome.number("longest_off_s")) + " s");
  add(outcome.number("jumps") > 0.0, text_of(outcome.number("jumps")) + " jumps");
  add(outcome.number("error_rms_m") > 0.10, "RMSE " + text_of(outcome.number("error_rms_m")) + " m");
  add(outcome.number("gate_shut_while_right") > 0.15,
      "gate shut " + text_of(outcome.number("gate_shut_while_right")) + ", longest: " + longest_shut_by(outcome));
  add(outcome.number("cells_written_astray") > 0.0,
      text_of(outcome.number("cells_written_astray")) + " cells written astray");
  add(outcome.number("skill") < 0.7, "skill " + text_of(outcome.number("skill")));
  add(outcome.number("recall") < 0.9, "recall " + text_of(outcome.number("recall")));
  add(outcome.number("precision") < 0.9, "precision " + text_of(outcome.number("precision")));
  add(outcome.number("wall_drift_m") > 0.02, "walls drifted " + text_of(outcome.number("wall_drift_m")) + " m");
  return failure;
}

TextTable failed_seeds(const std::vector<Outcome>& outcomes) {
  TextTable table{
      "Failed seeds", {"seed", "world", "laser", "map", "start", "what failed", "first off after, s", "then"}, {}};
  for (const Outcome& outcome : outcomes) {
    const std::string failure = failure_of(outcome);
    if (failure.empty()) continue;
    table.rows.push_back({outcome.label("seed"), outcome.label("layout"), outcome.label("laser"), outcome.label("map"),
                          outcome.label("start"), failure, text_of(outcome.number("first_off_s")),
                          outcome.label("cause")});
  }
  return table;
}

/// The longest first.
TextTable shut_while_right(const std::vector<Outcome>& outcomes) {
  std::vector<std::pair<double, std::vector<std::string>>> rows;
  for (const std::string& why : all_whys_shut()) {
    double all_s = 0.0;
    std::size_t seeds = 0;
    const Outcome* worst = nullptr;
    for (const Outcome& outcome : outcomes) {
      const double shut_s = outcome.number(shut_number(why));
      all_s += shut_s;
      seeds += shut_s > 0.0 ? 1 : 0;
      if (worst == nullptr || shut_s > worst->number(shut_number(why))) worst = &outcome;
    }
    if (seeds == 0) continue;
    rows.push_back({all_s, {why, text_of(std::round(all_s)), std::to_string(seeds), worst->label("seed")}});
  }
  std::stable_sort(rows.begin(), rows.end(), [](const auto& a, const auto& b) { return a.first > b.first; });
  TextTable table{
      "Why the gate was shut while the pose was right", {"why", "s, all seeds", "seeds", "longest in seed"}, {}};
  for (auto& row : rows) table.rows.push_back(std::move(row.second));
  return table;
}

/// By RMSE of the pose, the worst first: those whose start was never found.
std::vector<const Outcome*> worst_of(const std::vector<Outcome>& outcomes) {
  const auto error_m = [](const Outcome& outcome) {
    const double rms_m = outcome.number("error_rms_m");
    return std::isnan(rms_m) ? std::numeric_limits<double>::infinity() : rms_m;
  };
  std::vector<const Outcome*> worst;
  worst.reserve(outcomes.size());
  for (const Outcome& outcome : outcomes) worst.push_back(&outcome);
  std::stable_sort(worst.begin(), worst.end(),
                   [&](const Outcome* a, const Outcome* b) { return error_m(*a) > error_m(*b); });
  worst.resize(std::min(worst.size(), kShown));
  return worst;
}

Chart error_chart(const std::vector<const Outcome*>& worst) {
  Chart chart{"Error of the pose in the worst seeds, m", "time, s", "error, m", {}};
  for (const Outcome* outcome : worst) {
    Series series{"seed " + outcome->label("seed"), {}};
    const std::vector<double> time_s = outcome->scans.column("t_s");
    const std::vector<double> error_m = outcome->scans.column("error_m");
    double next_s = 0.0;
    for (std::size_t i = 0; i < time_s.size(); ++i) {
      if (time_s[i] < next_s) continue;
      series.points.emplace_back(time_s[i], error_m[i]);
      next_s = time_s[i] + kChartEvery_s;
    }
    chart.series.push_back(std::move(series));
  }
  return chart;
}

std::vector<Run> runs_of(const Options& options) {
  return unseen_runs(options, {kSeeds, kQuickSeeds, kMinutes, kQuickMinutes},
                     [options](std::uint64_t seed, double minutes) {
                       return unseen_drive(seed, minutes, options.localizer, options.mapping);
                     });
}

Report report_of(const std::vector<Outcome>& outcomes) {
  Report report;
  report.figures = {count_of_seeds(
                        "seeds off by more than 0.5 m for more than 5 s", outcomes,
                        [](const Outcome& o) { return o.number("stretches_off") > 0.0; }, Target{.most = 1.0}),
                    count_of_seeds("seeds whose start was not found", outcomes,
                                   [](const Outcome& o) { return o.number("start_found") == 0.0; }),
                    count_of_seeds("seeds that failed in any way", outcomes,
                                   [](const Outcome& o) { return !failure_of(o).empty(); })};
  for (Figure& figure : spread_figures(asked(), outcomes)) report.figures.push_back(std::move(figure));
  report.charts.push_back(chart_in_order("RMSE of the pose, m", "error_rms_m", outcomes));
  report.charts.push_back(chart_in_order("skill of the map", "skill", outcomes));
  report.charts.push_back(
      chart_in_order("gate shut while the pose is right, share of the time", "gate_shut_while_right", outcomes));
  const std::vector<const Outcome*> worst = worst_of(outcomes);
  report.charts.push_back(error_chart(worst));
  for (const Outcome* outcome : worst) {
    for (const Picture& picture : outcome->pictures)
      report.pictures.push_back({"Seed " + outcome->label("seed") + ": " + picture.title, picture.svg});
  }
  report.tables.push_back(failed_seeds(outcomes));
  report.tables.push_back(shut_while_right(outcomes));
  return report;
}

}  // namespace

Experiment unseen_experiment() {
  return {.name = "unseen",
          .what =
              "Worlds that nobody has tuned on, another kind for every seed (1-999: development; 1000-1059: final "
              "figures)",
          .runs = runs_of,
          .report = report_of,
          .times = Experiment::Times::kThread};
}

}  // namespace deltamap::experiments
