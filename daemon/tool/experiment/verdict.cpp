// SPDX-License-Identifier: Apache-2.0
// `verdict`: does the robot know whether it is lost or the map is out of date? In the paper's hall, whose four-fold
// symmetry leaves a carried robot no way to know, and in a depot where every place is its own.
#include <algorithm>
#include <array>
#include <cmath>

#include "daemon/tool/experiment/registry.hpp"
#include "daemon/tool/experiment/verdict_run.hpp"
#include "daemon/tool/experiment/verdict_score.hpp"

namespace deltamap::daemon::tool::experiment {
namespace {

constexpr std::array kChangedShares{0.0, 0.1, 0.5};
constexpr std::array kRanges_m{80.0, 8.0};  // runs take turns
constexpr double kCalledTooLong_s = 5.0;
constexpr double kRecovery_s = 30.0;

/// Three who walk about the corridors.
std::vector<simulation::PersonParams> walkers() {
  simulation::PersonParams upright{.path = {{16.2, 2.0}, {16.2, 33.0}}, .speed_m_per_s = 1.2};
  simulation::PersonParams level{.path = {{2.0, 18.8}, {33.0, 18.8}}, .speed_m_per_s = 1.0};
  simulation::PersonParams round{
      .path = {{3.6, 3.6}, {31.4, 3.6}, {31.4, 30.0}, {3.6, 31.4}}, .closed = true, .speed_m_per_s = 1.3};
  return {upright, level, round};
}

struct Place {
  std::string name;
  VerdictPlace place;
  std::array<std::shared_ptr<LivedIn>, kRanges_m.size()> lived_in;
};

std::shared_ptr<const Place> place_of(const std::string& name, const Options& options) {
  auto made = std::make_shared<Place>();
  made->name = name;
  VerdictPlace& place = made->place;
  place.scenario = simulation::read_scenario(options.scenarios / (name + ".yaml"));
  place.people = place.scenario.people.empty() ? walkers() : std::vector<simulation::PersonParams>{};
  place.map = first_map(place.scenario);
  place.localizer = options.localizer;
  LivedInParams lived_in;
  lived_in.seed = options.seed;
  lived_in.minutes = options.minutes.value_or(options.quick ? 6.0 : 15.0);
  for (std::size_t i = 0; i < kRanges_m.size(); ++i) {
    lived_in.max_range_m = kRanges_m[i];
    made->lived_in[i] = std::make_shared<LivedIn>(place.scenario, place.people, place.localizer, place.map, lived_in);
  }
  return made;
}

Outcome outcome_of(const Place& place, const VerdictRun& run, std::size_t range) {
  Outcome outcome;
  outcome.scans = verdict_scans(place.place, place.lived_in[range]->stability(), run);
  outcome.labels = {{"place", place.name},
                    {"event", std::string{name_of(run.event)}},
                    {"changed", text_of(run.changed_share)},
                    {"range_m", text_of(run.max_range_m)},
                    {"seed", std::to_string(run.seed)}};
  outcome.numbers = verdict_numbers(outcome.scans);
  return outcome;
}

class Verdict : public Experiment {
 public:
  [[nodiscard]] std::string name() const override { return "verdict"; }
  [[nodiscard]] std::string what() const override {
    return "Lost, or the map out of date? Poses right, a bay off, slipped and elsewhere, in halls that changed and did "
           "not";
  }
  [[nodiscard]] std::vector<Run> runs(const Options& options) const override;
  [[nodiscard]] Report report(const std::vector<Outcome>& outcomes) const override;
};

std::vector<Run> Verdict::runs(const Options& options) const {
  const int repeats = options.repeats.value_or(options.quick ? 5 : 50);
  std::vector<Run> runs;
  for (const std::string name : {"hall", "depot"}) {
    const auto place = place_of(name, options);
    for (const PoseEvent event : kPoseEvents) {
      for (const double changed : kChangedShares) {
        for (int i = 0; i < repeats; ++i) {
          const std::size_t range = static_cast<std::size_t>(i) % kRanges_m.size();
          VerdictRun run;
          run.seed = options.seed + 1000 + static_cast<std::uint64_t>(i);
          run.event = event;
          run.changed_share = changed;
          run.max_range_m = kRanges_m[range];
          if (options.minutes) run.before_s = std::min(run.before_s, 60.0 * *options.minutes / 7.0);
          if (options.minutes) run.after_s = std::min(run.after_s, 6.0 * run.before_s);
          runs.push_back({name + "-" + std::string{name_of(event)} + "-changed" + text_of(100.0 * changed) + "-" +
                              std::to_string(i),
                          [=] { return outcome_of(*place, run, range); }});
        }
      }
    }
  }
  return runs;
}

/// Some of the runs, and what they have in common.
class Part {
 public:
  template <typename Belongs>
  Part(const std::vector<Outcome>& outcomes, Belongs&& belongs) {
    for (const Outcome& outcome : outcomes) {
      if (belongs(outcome)) chosen_.push_back(&outcome);
    }
  }
  [[nodiscard]] double runs() const { return static_cast<double>(chosen_.size()); }
  template <typename Claim>
  [[nodiscard]] double count(Claim&& claim) const {
    return static_cast<double>(
        std::count_if(chosen_.begin(), chosen_.end(), [&](const Outcome* outcome) { return claim(*outcome); }));
  }
  /// Those that once were wrong.
  [[nodiscard]] double wrong() const { return count(was_wrong); }
  [[nodiscard]] double wrong_called_right() const {
    return count([](const Outcome& o) { return o.number("wrong_called_right_s") > kCalledTooLong_s; });
  }
  [[nodiscard]] double right_called_lost() const {
    return count([](const Outcome& o) { return o.number("right_called_lost_s") > 0.0; });
  }
  [[nodiscard]] double recovered_in(double limit_s) const {
    return count([&](const Outcome& o) { return was_wrong(o) && o.number("recovered_s") <= limit_s; });
  }
  /// Seconds; those that did not are as late as can be.
  [[nodiscard]] double recovery_quantile_s(double share) const {
    std::vector<double> times_s;
    for (const Outcome* outcome : chosen_) {
      const double time_s = outcome->number("recovered_s");
      if (was_wrong(*outcome)) times_s.push_back(std::isnan(time_s) ? HUGE_VAL : time_s);
    }
    const double answer_s = quantile(times_s, share);
    return std::isfinite(answer_s) ? answer_s : std::nan("");
  }
  [[nodiscard]] double mean(const char* number) const {
    std::vector<double> values;
    for (const Outcome* outcome : chosen_) {
      if (!std::isnan(outcome->number(number))) values.push_back(outcome->number(number));
    }
    return mean_of(values);
  }
  /// Share of the time, of those that never were wrong.
  [[nodiscard]] double called_right_when_right() const {
    std::vector<double> shares;
    for (const Outcome* outcome : chosen_) {
      if (!was_wrong(*outcome)) shares.push_back(outcome->number("called_right_share"));
    }
    return mean_of(shares);
  }
  [[nodiscard]] Reliability pose() const {
    Reliability all;
    for (const Outcome* outcome : chosen_) all = pose_reliability(outcome->scans, std::move(all));
    return all;
  }
  [[nodiscard]] Reliability map() const {
    Reliability all;
    for (const Outcome* outcome : chosen_) all = map_reliability(outcome->scans, std::move(all));
    return all;
  }

 private:
  static bool was_wrong(const Outcome& outcome) { return outcome.number("was_wrong") > 0.5; }
  std::vector<const Outcome*> chosen_;
};

double share_of(double part, double whole) { return whole > 0.0 ? part / whole : std::nan(""); }

std::string of(double part, double whole) { return text_of(part) + " of " + text_of(whole); }

TextTable table_of(const std::vector<Outcome>& outcomes, const std::string& place) {
  TextTable table{
      place,
      {"event", "changed", "range, m", "runs", "once wrong", "wrong called right > 5 s", "right called lost",
       "recovered in 30 s", "recovered in 60 s", "noticed after, mean s", "Brier pose", "Brier map"},
      {}};
  for (const PoseEvent event : kPoseEvents) {
    for (const double changed : kChangedShares) {
      for (const double range_m : kRanges_m) {
        const Part part{outcomes, [&](const Outcome& o) {
                          return o.label("place") == place && o.label("event") == name_of(event) &&
                                 o.label("changed") == text_of(changed) && o.label("range_m") == text_of(range_m);
                        }};
        if (part.runs() == 0.0) continue;
        const double wrong = part.wrong();
        table.rows.push_back(
            {std::string{name_of(event)}, text_of(100.0 * changed) + " %", text_of(range_m), text_of(part.runs()),
             text_of(wrong), text_of(part.wrong_called_right()), of(part.right_called_lost(), part.runs() - wrong),
             of(part.recovered_in(kRecovery_s), wrong), of(part.recovered_in(HUGE_VAL), wrong),
             text_of(part.mean("noticed_s")), text_of(part.pose().brier()), text_of(part.map().brier())});
      }
    }
  }
  return table;
}

Series series_of(const Reliability& reliability, const std::string& name) {
  Series series{name, {}};
  for (const Reliability::Bin& bin : reliability.bins) {
    if (bin.scans > 0.0) series.points.emplace_back(bin.given / bin.scans, bin.came / bin.scans);
  }
  return series;
}

TextTable table_of(const Reliability& reliability, const std::string& title) {
  TextTable table{title, {"given", "mean", "came true", "scans"}, {}};
  for (std::size_t i = 0; i < reliability.bins.size(); ++i) {
    const Reliability::Bin& bin = reliability.bins[i];
    const double low = 0.1 * static_cast<double>(i);
    table.rows.push_back({text_of(low) + "–" + text_of(low + 0.1), text_of(bin.given / bin.scans),
                          text_of(bin.came / bin.scans), text_of(bin.scans)});
  }
  return table;
}

void add_figures(Report& report, const std::string& place, const Part& part) {
  const double wrong = part.wrong();
  const double right = part.runs() - wrong;
  const auto add = [&](const std::string& what, double value, const std::string& unit, std::optional<Target> target) {
    report.figures.push_back({place + ": " + what, value, unit, target});
  };
  add("wrong poses called right for more than 5 s", share_of(part.wrong_called_right(), wrong), "",
      Target{.most = 0.01});
  add("right poses called lost", share_of(part.right_called_lost(), right), "", Target{.most = 0.02});
  add("Brier score of P(pose right)", part.pose().brier(), "", std::nullopt);
  add("Brier score of P(map wrong)", part.map().brier(), "", std::nullopt);
  // In the hall other places look the same: to come right again is luck.
  const auto recovery = place == "hall" ? std::nullopt : std::optional{Target{.least = 0.95}};
  add("wrong poses right again, and called so, within 30 s", share_of(part.recovered_in(kRecovery_s), wrong), "",
      recovery);
  add("wrong poses right again, and called so, at all", share_of(part.recovered_in(HUGE_VAL), wrong), "", std::nullopt);
  add("half of the wrong poses right again after", part.recovery_quantile_s(0.5), "s", std::nullopt);
  add("runs once wrong", wrong, "", std::nullopt);
  add("runs never wrong", right, "", std::nullopt);
  add("time called right in runs never wrong", part.called_right_when_right(), "", std::nullopt);
}

Report Verdict::report(const std::vector<Outcome>& outcomes) const {
  Report report;
  for (const std::string place : {"hall", "depot"}) {
    const Part part{outcomes, [&](const Outcome& outcome) { return outcome.label("place") == place; }};
    add_figures(report, place, part);
    report.tables.push_back(table_of(outcomes, place));
    const Reliability pose = part.pose();
    const Reliability map = part.map();
    report.tables.push_back(table_of(pose, place + ": P(pose right)"));
    report.tables.push_back(table_of(map, place + ": P(map wrong)"));
    report.charts.push_back({place + ": reliability",
                             "probability given",
                             "share that came true",
                             {series_of(pose, "pose right"), series_of(map, "map wrong")},
                             true});
  }
  return report;
}

}  // namespace

std::unique_ptr<Experiment> verdict_experiment() { return std::make_unique<Verdict>(); }

}  // namespace deltamap::daemon::tool::experiment
