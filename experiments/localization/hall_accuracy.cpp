// SPDX-License-Identifier: Apache-2.0
// `hall`: how exact the localizer alone is in the paper's hall while nothing changes, with a laser of 80 and of 8 m.
#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

#include "experiments/drive/first_map.hpp"
#include "experiments/drive/localizer_variants.hpp"
#include "experiments/drive/mapping_drive.hpp"
#include "experiments/localization/weakest_axis.hpp"
#include "experiments/pooled_runs.hpp"
#include "experiments/registry.hpp"
#include "experiments/report/svg_map.hpp"

namespace deltamap::experiments {
namespace {

constexpr double kLost_m = 0.5;
constexpr double kUnobserved = 0.05;  // share of information along an axis below which it counts as unobserved
// 95 % quantiles of χ² with 1, 2 and 3 degrees of freedom.
constexpr double kInside1 = 3.841;
constexpr double kInside2 = 5.991;
constexpr double kInside3 = 7.815;

std::vector<double> row_of(const Mapped& scan, const WeakestAxis& axis) {
  const PoseError error = error_of(scan);
  const PoseCovariance& covariance = scan.estimate.covariance;
  const Eigen::Matrix2d position_covariance = covariance.topLeftCorner<2, 2>();
  const Eigen::Vector3d pose_error{error.position.x(), error.position.y(), error.heading_rad};
  const double along_m = error.position.dot(axis.direction);
  const double across_m = axis.direction.x() * error.position.y() - axis.direction.y() * error.position.x();
  const double along_variance = axis.direction.dot(position_covariance * axis.direction);
  return {scan.passed_s,
          scan.map_from_robot.x,
          scan.map_from_robot.y,
          scan.map_from_robot.theta,
          error.position.norm(),
          error.heading_rad,
          across_m,
          along_m,
          axis.share,
          along_m * along_m / along_variance,
          error.position.dot(position_covariance.ldlt().solve(error.position)),
          pose_error.dot(covariance.ldlt().solve(pose_error)),
          static_cast<double>(scan.estimate.state),
          static_cast<double>(scan.estimate.particles)};
}

ScanTable empty_table() {
  return ScanTable{{"t_s", "x_m", "y_m", "theta_rad", "error_m", "heading_error_rad", "across_m", "along_m",
                    "information_share", "along_chi2", "position_chi2", "pose_chi2", "state", "particles"}};
}

/// Share of truths inside the 95 % interval along the axis, of the scans where it is unobserved.
double inside_where_unobserved(const ScanTable& scans) {
  const std::vector<double> share = scans.column("information_share");
  const std::vector<double> chi2 = scans.column("along_chi2");
  std::vector<double> chosen;
  for (std::size_t i = 0; i < share.size(); ++i) {
    if (share[i] <= kUnobserved) chosen.push_back(chi2[i]);
  }
  return 1.0 - share_above(chosen, kInside1);
}

/// What is told of one run, and of all runs of a kind together.
std::vector<std::pair<std::string, double>> numbers_of(const ScanTable& scans) {
  const std::vector<double> error = scans.column("error_m");
  std::vector<double> heading = scans.column("heading_error_rad");
  for (double& value : heading) value = std::abs(degrees(value));
  const std::vector<double> state = scans.column("state");
  const std::vector<double> share = scans.column("information_share");
  return {{"scans", static_cast<double>(scans.rows())},
          {"rmse_m", root_mean_square(error)},
          {"p95_m", quantile(error, 0.95)},
          {"heading_p95_deg", quantile(heading, 0.95)},
          {"across_rmse_m", root_mean_square(scans.column("across_m"))},
          {"along_rmse_m", root_mean_square(scans.column("along_m"))},
          {"beyond_half_metre", share_above(error, kLost_m)},
          {"inside_along", 1.0 - share_above(scans.column("along_chi2"), kInside1)},
          {"inside_position", 1.0 - share_above(scans.column("position_chi2"), kInside2)},
          {"inside_pose", 1.0 - share_above(scans.column("pose_chi2"), kInside3)},
          {"inside_unobserved", inside_where_unobserved(scans)},
          {"unobserved", 1.0 - share_above(share, kUnobserved)},
          {"not_tracking", share_above(state, 1.5) + 1.0 - share_above(state, 0.5)},
          {"particles", mean_of(scans.column("particles"))}};
}

Outcome follow(const simulation::Scenario& scenario, const LocalizerVariant& setting, double range_m,
               std::uint64_t seed, double minutes) {
  simulation::VirtualDriveParams drive;
  drive.seed = seed;
  drive.max_range_m = range_m;
  const auto map = first_map(scenario);
  MappingDrive pair{scenario, drive, localizer_alone(setting.params), {map}};
  Outcome outcome;
  outcome.scans = empty_table();
  TrajectoryPair paths;
  for (double passed_s = 0.0; passed_s < 60.0 * minutes;) {
    const Mapped scan = pair.next();
    passed_s = scan.passed_s;
    const Pose2 map_from_laser = scan.map_from_robot * scenario.laser.optics.robot_from_laser;
    outcome.scans.add(
        row_of(scan, weakest_axis(pair.drive().world(), pair.drive().surfaces(), map_from_laser, range_m)));
    paths.add(passed_s, scan.map_from_robot.position(), scan.estimate.map_from_robot.position());
  }
  outcome.labels = {{"setting", setting.name}, {"range_m", text_of(range_m)}, {"seed", std::to_string(seed)}};
  outcome.numbers = numbers_of(outcome.scans);
  outcome.pictures = {{"robot green, believed magenta", svg_of_trajectories(*map, paths)}};
  return outcome;
}

std::vector<Run> runs_of(const Options& options) {
  const auto scenario = scenario_of(options, "hall.yaml");
  const double minutes = options.minutes.value_or(options.quick ? 2.0 : 10.0);
  std::vector<Run> runs;
  for (const LocalizerVariant& setting : localizer_variants(options.localizer)) {
    for (const double range_m : {80.0, 8.0}) {
      for (const std::uint64_t seed : options.seeds(5)) {
        runs.push_back({setting.name + "-" + text_of(range_m) + "m-seed" + std::to_string(seed),
                        [=] { return follow(*scenario, setting, range_m, seed, minutes); }});
      }
    }
  }
  return runs;
}

void add_figures(Report& report, const std::string& setting, const std::string& range, const PooledRuns& all) {
  const std::string where = setting + ", " + range + " m: ";
  const bool far = range == "80";
  const auto add = [&](const std::string& what, const std::string& number, const std::string& unit,
                       std::optional<Target> target, const std::string& peers = "") {
    report.figures.push_back(all.figure(where + what, number, unit, target, peers));
  };
  add("RMSE", "rmse_m", "m", far ? std::optional{Target{.most = 0.02}} : std::nullopt,
      far ? "nav2 LF-prob 0.031, MRPT 0.039, iris_lama 0.045" : "MRPT 0.083, nav2 0.144, iris_lama 2.0");
  add("95 % of scans within", "p95_m", "m", std::nullopt);
  add("heading, 95 % of scans within", "heading_p95_deg", "deg",
      far ? std::optional{Target{.most = 0.3}} : std::nullopt);
  add("RMSE across the weakest axis", "across_rmse_m", "m", far ? std::nullopt : std::optional{Target{.most = 0.03}});
  add("RMSE along the weakest axis", "along_rmse_m", "m", far ? std::nullopt : std::optional{Target{.most = 0.10}});
  add("scans off by more than 0.5 m", "beyond_half_metre", "", Target{.most = 0.0},
      far ? "" : "MRPT 0, nav2 0.02, iris_lama 0.09");
  const Target ellipse{.least = 0.90, .most = 0.98};
  add("true position inside the 95 % ellipse", "inside_position", "", ellipse);
  add("true pose inside the 95 % ellipsoid", "inside_pose", "", ellipse);
  add("truth inside the 95 % interval along the weakest axis", "inside_along", "", ellipse);
  if (!far) add("scans inside the 95 % ellipse where the weakest axis is unobserved", "inside_unobserved", "", ellipse);
  add("scans whose weakest axis is unobserved", "unobserved", "", std::nullopt);
  add("scans not tracking", "not_tracking", "", std::nullopt);
  add("particles, mean", "particles", "", std::nullopt);
}

Series errors_over_time(const Outcome& outcome, const std::string& name) {
  Series series{name, {}};
  const std::size_t every = std::max<std::size_t>(1, outcome.scans.rows() / 600);
  const std::size_t time = outcome.scans.index_of("t_s");
  const std::size_t error = outcome.scans.index_of("error_m");
  for (std::size_t row = 0; row < outcome.scans.rows(); row += every) {
    series.points.emplace_back(outcome.scans.at(row, time), outcome.scans.at(row, error));
  }
  return series;
}

Report report_of(const std::vector<Outcome>& outcomes) {
  Report report;
  for (const std::string setting : {"500x60", "delivered"}) {
    for (const std::string range : {"80", "8"}) {
      const PooledRuns all{runs_with(outcomes, {{"setting", setting}, {"range_m", range}}), numbers_of};
      if (all.empty()) continue;  // not asked for
      add_figures(report, setting, range, all);
      const std::string title = std::string{setting}.append(", ").append(range).append(" m");
      Chart chart{title, "time, s", "error of position, m", {}};
      for (const Outcome* outcome : all.runs())
        chart.series.push_back(errors_over_time(*outcome, "seed " + outcome->label("seed")));
      report.charts.push_back(std::move(chart));
      add_pictures(report, title, *all.runs().front());
    }
  }
  return report;
}

}  // namespace

Experiment hall_experiment() {
  return {.name = "hall",
          .what = "The localizer alone in the paper's hall, nothing changes, with a laser of 80 m and of 8 m",
          .runs = runs_of,
          .report = report_of};
}

}  // namespace deltamap::experiments
