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

std::vector<double> numbers(const std::vector<const Outcome*>& drives, const char* name) {
  std::vector<double> values;
  values.reserve(drives.size());
  for (const Outcome* drive : drives) values.push_back(drive->number(name));
  return values;
}

Figure mean_figure(const std::string& name, const std::vector<double>& values, const std::string& unit,
                   const std::optional<Target>& target = {}) {
  return {name, mean_of(values), unit, target, "", certainty_of_mean(values)};
}

Figure worst_figure(const std::string& name, const std::vector<double>& values, const std::string& unit,
                    const std::optional<Target>& target) {
  return {name, quantile(values, 1.0), unit, target, "", certainty_of_extreme(values)};
}

std::vector<Figure> figures_of(const Kind& kind, const std::vector<const Outcome*>& drives) {
  const Target none{.most = 0.0};
  const auto of = [&](const char* name) { return numbers(drives, name); };
  const std::string wheels = kind.name + ": wheels after 15 min, ";
  return {worst_figure(kind.name + ": RMSE of the worst drive", of("error_rms_m"), "m", kind.rms_m),
          mean_figure(kind.name + ": RMSE, mean", of("error_rms_m"), "m"),
          worst_figure(kind.name + ": farthest scan", of("error_most_m"), "m", kind.farthest_m),
          mean_figure(kind.name + ": time off by more than 0.5 m", of("off_share"), "", none),
          worst_figure(kind.name + ": jumps away from a right pose, most", of("jumps"), "", none),
          worst_figure(wheels + "distance, worst error", of("wheel_distance_error"), "", Target{.most = 0.002}),
          worst_figure(wheels + "turn, worst error", of("wheel_turn_error"), "", Target{.most = 0.003}),
          worst_figure(wheels + "lag, worst error", of("wheel_lag_error_s"), "s", Target{.most = 0.02})};
}

Chart chart_of_errors(const Kind& kind, const std::vector<const Outcome*>& drives) {
  Chart chart{kind.name + ": error", "time, min", "position, m", {}};
  for (const Outcome* drive : drives) chart.series.push_back(error_series(*drive));
  return chart;
}

TextTable table_of_drives(const std::vector<Outcome>& outcomes) {
  TextTable table{"Every drive", {"kind", "seed", "RMSE, m", "farthest, m", "off", "jumps", "cause"}, {}};
  for (const Outcome& outcome : outcomes) {
    table.rows.push_back({outcome.label("kind"), outcome.label("seed"), text_of(outcome.number("error_rms_m")),
                          text_of(outcome.number("error_most_m")), text_of(outcome.number("off_share")),
                          text_of(outcome.number("jumps")), outcome.label("cause")});
  }
  return table;
}

Report report_of(const std::vector<Outcome>& outcomes) {
  Report report;
  for (const Kind& kind : kinds()) {
    const std::vector<const Outcome*> drives = runs_with(outcomes, {{"kind", kind.name}});
    if (drives.empty()) continue;  // not asked for
    add_pictures(report, kind.name, *drives.front());
    for (Figure& figure : figures_of(kind, drives)) report.figures.push_back(std::move(figure));
    report.charts.push_back(chart_of_errors(kind, drives));
  }
  report.tables.push_back(table_of_drives(outcomes));
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
