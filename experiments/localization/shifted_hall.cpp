// SPDX-License-Identifier: Apache-2.0
// `shifted-hall`: an hour among containers of 5 m, one of which is shifted every minute, with poorly calibrated wheels;
// the map never updated, or live.
#include "simulation/drawn/shifted_hall.hpp"

#include <cmath>
#include <optional>

#include "core/geometry/angle.hpp"
#include "experiments/drive/first_map.hpp"
#include "experiments/pooled_runs.hpp"
#include "experiments/registry.hpp"
#include "experiments/watch/watched_drive.hpp"

namespace deltamap::experiments {
namespace {

using simulation::drawn::ShiftedHallParams;

struct Kind {
  std::string name;
  ShiftedHallParams hall;
  bool is_live = true;
  Target rms_m;
  std::optional<Target> farthest_m{};
};

std::vector<Kind> kinds() {
  std::vector<Kind> all;
  for (const double range_m : {80.0, 8.0}) {
    const std::string range = text_of(range_m) + "m-";
    const bool is_far = range_m > 8.0;
    all.push_back({range + "live", {.range_m = range_m}, true, {.most = is_far ? 0.008 : 0.02}, Target{.most = 0.1}});
    all.push_back({range + "stale", {.range_m = range_m}, false, {.most = is_far ? 0.02 : 0.05}});
    all.push_back({range + "slips", {.range_m = range_m, .slips = true}, true, {.most = 0.05}});
    all.push_back({range + "noise", {.range_m = range_m, .wheel_noise_times = 4.0}, true, {.most = 0.05}});
    all.push_back({range + "turned", {.range_m = range_m, .largest_turn_rad = radians(10.0)}, true, {.most = 0.05}});
    all.push_back({range + "all",
                   {.range_m = range_m,
                    .slips = true,
                    .wheel_noise_times = 4.0,
                    .crowd = true,
                    .largest_turn_rad = radians(10.0)},
                   true,
                   {.most = 0.05},
                   Target{.most = 0.3}});
  }
  return all;
}

std::vector<Run> runs_of(const Options& options) {
  std::vector<Run> runs;
  const double minutes = options.minutes.value_or(options.quick ? 5.0 : 60.0);
  for (const Kind& kind : kinds()) {
    for (const std::uint64_t seed : options.seeds(3)) {
      runs.push_back(
          {kind.name + "-seed" + std::to_string(seed), [=] {
             auto [scenario, drive] = simulation::drawn::shifted_hall(kind.hall, seed);
             WatchedRun run{scenario, drive, first_map(scenario), {}, minutes};
             run.settings.localizer = options.localizer;
             run.settings.mapping = options.mapping;
             run.settings.mapping.enabled = options.mapping.enabled && kind.is_live;
             Outcome outcome = watched_drive(run);
             outcome.labels.insert(outcome.labels.begin(), {{"kind", kind.name}, {"seed", std::to_string(seed)}});
             return outcome;
           }});
    }
  }
  return runs;
}

Series error_series(const Outcome& outcome) {
  Series series{"seed " + outcome.label("seed"), {}};
  const std::vector<double> time_s = outcome.scans.column("t_s");
  const std::vector<double> error_m = outcome.scans.column("error_m");
  for (std::size_t i = 0; i < time_s.size(); ++i) series.points.emplace_back(time_s[i] / 60.0, error_m[i]);
  return series;
}

Report report_of(const std::vector<Outcome>& outcomes) {
  Report report;
  for (const Kind& kind : kinds()) {
    std::vector<double> rms_m, most_m, off, jumps, wheel_distance, wheel_turn, wheel_lag_s;
    Chart errors{kind.name + ": error", "time, min", "position, m", {}};
    for (const Outcome& outcome : outcomes) {
      if (outcome.label("kind") != kind.name) continue;
      rms_m.push_back(outcome.number("error_rms_m"));
      most_m.push_back(outcome.number("error_most_m"));
      off.push_back(outcome.number("off_share"));
      jumps.push_back(outcome.number("jumps"));
      wheel_distance.push_back(outcome.number("wheel_distance_error"));
      wheel_turn.push_back(outcome.number("wheel_turn_error"));
      wheel_lag_s.push_back(outcome.number("wheel_lag_error_s"));
      errors.series.push_back(error_series(outcome));
    }
    if (rms_m.empty()) continue;  // not asked for
    add_pictures(report, kind.name, *runs_with(outcomes, {{"kind", kind.name}}).front());
    report.figures.push_back({kind.name + ": RMSE of the worst drive", quantile(rms_m, 1.0), "m", kind.rms_m, "",
                              certainty_of_extreme(rms_m)});
    report.figures.push_back({kind.name + ": RMSE, mean", mean_of(rms_m), "m", {}, "", certainty_of_mean(rms_m)});
    report.figures.push_back(
        {kind.name + ": farthest scan", quantile(most_m, 1.0), "m", kind.farthest_m, "", certainty_of_extreme(most_m)});
    const Target none{.most = 0.0};
    report.figures.push_back(
        {kind.name + ": time off by more than 0.5 m", mean_of(off), "", none, "", certainty_of_mean(off)});
    report.figures.push_back({kind.name + ": jumps away from a right pose, most", quantile(jumps, 1.0), "", none, "",
                              certainty_of_extreme(jumps)});
    const auto of_wheels = [&](const char* what, const std::vector<double>& errors_of, const char* unit, double most) {
      const std::string name = kind.name + ": wheels after 15 min, " + what + ", worst error";
      report.figures.push_back(
          {name, quantile(errors_of, 1.0), unit, Target{.most = most}, "", certainty_of_extreme(errors_of)});
    };
    of_wheels("distance", wheel_distance, "", 0.002);
    of_wheels("turn", wheel_turn, "", 0.003);
    of_wheels("lag", wheel_lag_s, "s", 0.02);
    report.charts.push_back(std::move(errors));
  }
  TextTable runs{"Every drive", {"kind", "seed", "RMSE, m", "farthest, m", "off", "jumps", "cause"}, {}};
  for (const Outcome& outcome : outcomes) {
    runs.rows.push_back({outcome.label("kind"), outcome.label("seed"), text_of(outcome.number("error_rms_m")),
                         text_of(outcome.number("error_most_m")), text_of(outcome.number("off_share")),
                         text_of(outcome.number("jumps")), outcome.label("cause")});
  }
  report.tables.push_back(std::move(runs));
  return report;
}

}  // namespace

Experiment shifted_hall_experiment() {
  return {.name = "shifted-hall",
          .what = "An hour among containers of 5 m that are shifted by up to 0.8 m, one a minute, with poor wheels",
          .runs = runs_of,
          .report = report_of,
          .times = Experiment::Times::kThread};
}

}  // namespace deltamap::experiments
