// SPDX-License-Identifier: Apache-2.0
// `stale-map`: an hour in the paper's hall while a container a minute is pushed aside and nobody tells the map.
#include <algorithm>
#include <cmath>

#include "experiments/drive/first_map.hpp"
#include "experiments/drive/localizer_variants.hpp"
#include "experiments/drive/mapping_drive.hpp"
#include "experiments/pooled_runs.hpp"
#include "experiments/registry.hpp"
#include "experiments/report/svg_map.hpp"

namespace deltamap::experiments {
namespace {

constexpr double kLost_m = 0.5;

ScanTable empty_table() {
  return ScanTable{{"t_s", "x_m", "y_m", "theta_rad", "error_m", "heading_error_rad", "state", "w_avg", "pose_right",
                    "map_wrong", "verdict", "changes"}};
}

std::vector<std::pair<std::string, double>> numbers_of(const ScanTable& scans) {
  const std::vector<double> error = scans.column("error_m");
  std::vector<double> heading = scans.column("heading_error_rad");
  for (double& value : heading) value = std::abs(degrees(value));
  const std::vector<double> state = scans.column("state");
  const std::vector<double> verdict = scans.column("verdict");
  return {{"scans", static_cast<double>(scans.rows())},
          {"rmse_m", root_mean_square(error)},
          {"median_m", quantile(error, 0.5)},
          {"p95_m", quantile(error, 0.95)},
          {"most_m", quantile(error, 1.0)},
          {"heading_p95_deg", quantile(heading, 0.95)},
          {"beyond_half_metre", share_above(error, kLost_m)},
          {"global", 1.0 - share_above(state, 0.5)},
          {"lost", share_above(state, 1.5)},
          {"pose_right", mean_of(scans.column("pose_right"))},
          {"map_wrong", mean_of(scans.column("map_wrong"))},
          {"called_right", share_above(verdict, 0.5) - share_above(verdict, 1.5)},
          {"called_wrong", share_above(verdict, 1.5)}};
}

Outcome follow(const simulation::Scenario& scenario, const LocalizerVariant& variant, double range_m,
               std::uint64_t seed, double minutes) {
  simulation::VirtualDriveParams drive;
  drive.seed = seed;
  drive.max_range_m = range_m;
  drive.forklift = scenario.forklift;
  const auto map = first_map(scenario);
  MappingDrive pair{scenario, drive, localizer_alone(variant.params), {map}};
  Outcome outcome;
  outcome.scans = empty_table();
  TrajectoryPair paths;
  std::size_t changes = 0;
  for (double passed_s = 0.0; passed_s < 60.0 * minutes;) {
    const Mapped scan = pair.next();
    passed_s = scan.passed_s;
    changes += scan.changes.size();
    paths.add(passed_s, scan.map_from_robot.position(), scan.estimate.map_from_robot.position());
    const PoseError error = error_of(scan);
    const Estimate& estimate = scan.estimate;
    outcome.scans.add({scan.passed_s, scan.map_from_robot.x, scan.map_from_robot.y, scan.map_from_robot.theta,
                       error.position.norm(), error.heading_rad, static_cast<double>(estimate.state), estimate.w_avg,
                       estimate.belief.pose_right, estimate.belief.map_wrong,
                       static_cast<double>(estimate.belief.verdict), static_cast<double>(changes)});
  }
  outcome.labels = {{"localizer", variant.name}, {"range_m", text_of(range_m)}, {"seed", std::to_string(seed)}};
  outcome.numbers = numbers_of(outcome.scans);
  outcome.numbers.emplace_back("changes", static_cast<double>(changes));
  outcome.pictures = {{"robot green, believed magenta, the map that nobody changes", svg_of_trajectories(*map, paths)}};
  return outcome;
}

std::vector<Run> runs_of(const Options& options) {
  const auto scenario = scenario_of(options, "hall_shifts.yaml");
  const double minutes = options.minutes.value_or(options.quick ? 5.0 : 60.0);
  std::vector<Run> runs;
  for (const LocalizerVariant& variant : localizer_variants(options.localizer)) {
    for (const double range_m : {80.0, 8.0}) {
      for (const std::uint64_t seed : options.seeds(3)) {
        runs.push_back({variant.name + "-" + text_of(range_m) + "m-seed" + std::to_string(seed),
                        [=] { return follow(*scenario, variant, range_m, seed, minutes); }});
      }
    }
  }
  return runs;
}

Series minute_by_minute(const ScanTable& scans, const std::string& column, const std::string& name) {
  Series series{name, {}};
  const std::vector<double> time_s = scans.column("t_s");
  const std::vector<double> value = scans.column(column);
  std::vector<double> in_minute;
  for (std::size_t i = 0; i < value.size(); ++i) {
    in_minute.push_back(value[i]);
    const bool ends = i + 1 == value.size() || std::floor(time_s[i + 1] / 60.0) > std::floor(time_s[i] / 60.0);
    if (!ends) continue;
    series.points.emplace_back(std::floor(time_s[i] / 60.0), mean_of(in_minute));
    in_minute.clear();
  }
  return series;
}

/// The same number of all runs: their scans weigh alike, for the drives are of one length.
class Pooled {
 public:
  Pooled(const std::vector<Outcome>& outcomes, const std::string& variant, const std::string& range) {
    for (const Outcome& outcome : outcomes) {
      if (outcome.label("localizer") == variant && outcome.label("range_m") == range) chosen_.push_back(&outcome);
    }
  }
  [[nodiscard]] double root_mean_square_of(const std::string& number) const { return root_mean_square(all(number)); }
  [[nodiscard]] Figure mean(const std::string& name, const std::string& number, const std::string& unit = "") const {
    return {name, mean_of(all(number)), unit, {}, "", certainty_of_mean(all(number))};
  }
  [[nodiscard]] Figure most(const std::string& name, const std::string& number, const std::string& unit) const {
    return {name, quantile(all(number), 1.0), unit, {}, "", certainty_of_extreme(all(number))};
  }
  [[nodiscard]] Certainty certainty_of_rms(const std::string& number) const {
    return certainty_of_root_mean_square(all(number));
  }
  [[nodiscard]] const std::vector<const Outcome*>& outcomes() const { return chosen_; }

 private:
  [[nodiscard]] std::vector<double> all(const std::string& number) const {
    std::vector<double> values;
    for (const Outcome* outcome : chosen_) values.push_back(outcome->number(number));
    return values;
  }
  std::vector<const Outcome*> chosen_;
};

void add_figures(Report& report, const std::string& variant, const std::string& range, const Pooled& pooled) {
  const std::string where = variant + ", " + range + " m: ";
  const bool far = range == "80";
  report.figures.push_back(
      {where + "RMSE", pooled.root_mean_square_of("rmse_m"), "m", Target{.most = far ? 0.15 : 0.25},
       far ? "iris_lama 0.165, amcl 0.255" : "amcl 0.283, iris_lama lost", pooled.certainty_of_rms("rmse_m")});
  Figure off = pooled.mean(where + "scans off by more than 0.5 m", "beyond_half_metre");
  off.target = Target{.most = far ? 0.02 : 0.05};
  off.peers = far ? "iris_lama 0.04" : "amcl 0.13";
  report.figures.push_back(std::move(off));
  report.figures.push_back(pooled.most(where + "RMSE of the worst drive", "rmse_m", "m"));
  report.figures.push_back(pooled.most(where + "farthest scan", "most_m", "m"));
  report.figures.push_back(pooled.mean(where + "heading, 95 % of scans within", "heading_p95_deg", "deg"));
  report.figures.push_back(pooled.mean(where + "scans lost", "lost"));
  report.figures.push_back(pooled.mean(where + "scans global", "global"));
  report.figures.push_back(pooled.mean(where + "scans called right", "called_right"));
  report.figures.push_back(pooled.mean(where + "scans called wrong", "called_wrong"));
  report.figures.push_back(pooled.mean(where + "P(pose right), mean", "pose_right"));
  report.figures.push_back(pooled.mean(where + "P(map wrong), mean", "map_wrong"));
  report.figures.push_back(pooled.mean(where + "changes of a drive", "changes"));
}

Report report_of(const std::vector<Outcome>& outcomes) {
  Report report;
  for (const std::string variant : {"500x60", "delivered"}) {
    for (const std::string range : {"80", "8"}) {
      const Pooled pooled{outcomes, variant, range};
      if (pooled.outcomes().empty()) continue;  // not asked for
      add_figures(report, variant, range, pooled);
      const std::string title = std::string{variant}.append(", ").append(range).append(" m");
      Chart errors{title, "time, min", "error of position, mean of a minute, m", {}};
      Chart belief{title + ": belief", "time, min", "probability, mean of a minute", {}};
      for (const Outcome* outcome : pooled.outcomes()) {
        const std::string seed = "seed " + outcome->label("seed");
        errors.series.push_back(minute_by_minute(outcome->scans, "error_m", seed));
        belief.series.push_back(minute_by_minute(outcome->scans, "pose_right", seed + " pose right"));
        belief.series.push_back(minute_by_minute(outcome->scans, "map_wrong", seed + " map wrong"));
      }
      report.charts.push_back(std::move(errors));
      report.charts.push_back(std::move(belief));
      add_pictures(report, title, *pooled.outcomes().front());
    }
  }
  return report;
}

}  // namespace

Experiment stale_map_experiment() {
  return {.name = "stale-map",
          .what = "The paper's hall, a container pushed aside by at most 0.8 m every minute, the map never updated",
          .runs = runs_of,
          .report = report_of};
}

}  // namespace deltamap::experiments
