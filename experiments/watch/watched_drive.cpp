// SPDX-License-Identifier: Apache-2.0
#include "experiments/watch/watched_drive.hpp"

#include <algorithm>
#include <array>
#include <limits>

#include "experiments/drive/mapping_drive.hpp"
#include "experiments/drive/view_difference.hpp"
#include "experiments/report/svg_map.hpp"
#include "experiments/watch/mapping_watch.hpp"
#include "experiments/watch/pose_course.hpp"

namespace deltamap::experiments {
namespace {

constexpr double kRowEvery_s = 1.0;
constexpr double kDiffers = 0.05;   // share of the beams above which a change is in view
constexpr double kFewBeams = 0.15;  // share of the beams below which little is in view
constexpr double kPersonNear_m = 3.0;
constexpr double kJudgeEvery_s = 5.0;
constexpr double kWheelsKnownAfter_s = 900.0;  // what was found of them is judged then, or at the end

/// Of a drive whose map may be updated.
constexpr std::array kMapNumbers{"changes_seen_10s",
                                 "recall",
                                 "precision",
                                 "skill",
                                 "f1",
                                 "f1_stale",
                                 "f1_perfect",
                                 "revisions",
                                 "refused",
                                 "cells_written",
                                 "cells_written_astray",
                                 "cells_withdrawn",
                                 "walls_kept",
                                 "wall_drift_m",
                                 "ghost_cells_at_end"};

bool is_person_near(const Mapped& scan) {
  const auto walkers = scan.about.walkers();
  return std::any_of(walkers.begin(), walkers.end(), [&](const simulation::Circle& person) {
    return (person.centre - scan.map_from_robot.position()).norm() < kPersonNear_m;
  });
}

/// Hardly a beam comes back.
bool is_little_in_view(const Scan& scan) {
  const auto ranges = std::count_if(scan.beams.begin(), scan.beams.end(),
                                    [](const Beam& beam) { return beam.kind == BeamKind::kRange; });
  return static_cast<double>(ranges) < kFewBeams * static_cast<double>(scan.beams.size());
}

/// Looks once a second what is different in view from the world of M_0.
class ChangedView {
 public:
  ChangedView(const WatchedRun& run)
      : first_{run.scenario.world},
        mount_{run.scenario.laser.optics.robot_from_laser},
        range_m_{run.drive.max_range_m} {}

  [[nodiscard]] double share(const simulation::VirtualDrive& drive, const Pose2& map_from_robot) const {
    return differing_share(first_, drive.surfaces(), map_from_robot * mount_, range_m_);
  }

 private:
  simulation::RayCaster first_;
  Pose2 mount_;
  double range_m_;
};

std::vector<std::pair<std::string, double>> map_numbers(std::optional<MappingWatch>& watch, const OccupancyGrid& map) {
  std::vector<std::pair<std::string, double>> chosen;
  const MappingWatch::Numbers all = watch ? watch->numbers(map) : MappingWatch::Numbers{};
  for (const char* name : kMapNumbers) {
    const auto found = std::find_if(all.begin(), all.end(), [&](const auto& number) { return number.first == name; });
    chosen.emplace_back(name, found == all.end() ? std::numeric_limits<double>::quiet_NaN() : found->second);
  }
  return chosen;
}

/// How far what was found of the wheels is from the truth; not a number where nothing is looked for.
std::vector<std::pair<std::string, double>> wheel_numbers(const WatchedRun& run,
                                                          const daemon::LocalizationStep& localizer) {
  const simulation::RobotParams& body = run.scenario.robot.body;
  const double driven_of_counted = 1.0 + 0.5 * (body.left_wheel_error + body.right_wheel_error);
  constexpr double kUnknown = std::numeric_limits<double>::quiet_NaN();
  localization::motion::WheelErrors found{kUnknown, kUnknown, kUnknown, kUnknown};
  if (const auto calibration = localizer.calibration()) found = calibration->wheels;
  return {{"wheel_distance_error", std::abs(1.0 + found.distance - driven_of_counted)},
          {"wheel_turn_error", std::abs(1.0 + found.turn - driven_of_counted / (1.0 + body.track_error))},
          {"wheel_lag_error_s", std::abs(found.lag_s - run.drive.odometry_lag_s)}};
}

MappingWatchParams watch_params(const WatchedRun& run) {
  return {
      .range_m = run.drive.max_range_m, .field_rad = radians(run.drive.fan.angle_deg), .judge_every_s = kJudgeEvery_s};
}

ScanTable no_seconds() {
  return ScanTable{{"t_s", "x_m", "y_m", "theta_rad", "error_m", "heading_error_rad", "state", "gate", "pose_right",
                    "changed_in_view"}};
}

void add_second(ScanTable& scans, const Mapped& scan, double changed_share) {
  const Pose2& truth = scan.map_from_robot;
  const Pose2& believed = scan.estimate.map_from_robot;
  scans.add({scan.passed_s, truth.x, truth.y, truth.theta, distance_between(truth, believed),
             turn_between(truth.theta, believed.theta), static_cast<double>(scan.estimate.state),
             static_cast<double>(scan.awareness.gate), scan.estimate.belief.pose_right, changed_share});
}

}  // namespace

Outcome watched_drive(const WatchedRun& run) {
  MappingDrive drive{run.scenario, run.drive, run.settings, {run.first_map}, run.knows_start};
  std::optional<MappingWatch> watch;
  if (run.settings.mapping.enabled) watch.emplace(run.scenario, run.first_map, watch_params(run));
  PoseCourse course{run.knows_start, run.scenario.laser.optics.robot_from_laser};
  const ChangedView changed_view{run};
  Outcome outcome;
  outcome.scans = no_seconds();
  TrajectoryPair paths;
  double changed_share = 0.0;
  double next_row_s = 0.0;
  std::vector<std::pair<std::string, double>> wheels;
  for (double passed_s = 0.0; passed_s < 60.0 * run.minutes;) {
    const Mapped scan = drive.next();
    passed_s = scan.passed_s;
    if (wheels.empty() && passed_s >= std::min(kWheelsKnownAfter_s, 60.0 * run.minutes))
      wheels = wheel_numbers(run, drive.localization());
    const bool writes_row = passed_s >= next_row_s;
    if (writes_row) changed_share = changed_view.share(drive.drive(), scan.map_from_robot);
    course.observe(scan, {changed_share > kDiffers, is_person_near(scan), is_little_in_view(scan.tracked.scan)});
    if (watch) watch->observe(scan, drive.map());
    if (!writes_row) continue;
    next_row_s = passed_s + kRowEvery_s;
    paths.add(passed_s, scan.map_from_robot.position(), scan.estimate.map_from_robot.position());
    add_second(outcome.scans, scan, changed_share);
  }
  outcome.pictures = {{"robot green, believed magenta; the map at the end, blue: only there, orange: only in the truth",
                       svg_of_difference(drive.map(), watch ? watch->truth() : drive.map(), paths.both())}};
  outcome.labels = {{"cause", course.cause()}};
  outcome.numbers = course.numbers();
  for (auto& number : map_numbers(watch, drive.map())) outcome.numbers.push_back(std::move(number));
  for (auto& number : wheels) outcome.numbers.push_back(std::move(number));
  return outcome;
}

}  // namespace deltamap::experiments
