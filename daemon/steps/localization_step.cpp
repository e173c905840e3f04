// SPDX-License-Identifier: Apache-2.0
#include "daemon/steps/localization_step.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <utility>

namespace deltamap::daemon {
namespace {

/// How far the robot may have been pushed and turned while it was off.
constexpr double kRememberedDeviationM = 0.5;
constexpr double kRememberedDeviationRad = radians(20.0);

constexpr double kSpunM = 0.1;      // claimed by the wheels of a robot that stands: they spin
constexpr double kKeptEachM = 1.0;  // driven between two copies of what is known of wheels and mount

std::optional<localization::particles::InitialPose> initial_pose(const Settings& settings, const StartMap& start) {
  if (settings.initial_pose) return localization::particles::InitialPose{*settings.initial_pose};
  if (!start.remembered) return std::nullopt;
  if (start.believed) {
    return localization::particles::InitialPose{*start.remembered, start.believed->position_m,
                                                start.believed->heading_rad};
  }
  return localization::particles::InitialPose{*start.remembered, kRememberedDeviationM, kRememberedDeviationRad, true};
}

}  // namespace

void require_pose_on(const GridGeometry& map, const Settings& settings) {
  if (!settings.initial_pose || map.contains(map.cell_at(settings.initial_pose->position()))) return;
  const Point2 high = map.origin + map.resolution_m * Point2{map.width, map.height};
  char text[256];
  (void)std::snprintf(text, sizeof text,
                      "'localization.initial_pose': %g,%g lies outside the map, which reaches from %g to %g m in x and "
                      "from %g to %g m in y",
                      settings.initial_pose->x, settings.initial_pose->y, map.origin.x(), high.x(), map.origin.y(),
                      high.y());
  throw SettingsError(text);
}

std::string doubt_of_pose(const OccupancyGrid& map, const Settings& settings) {
  if (!settings.initial_pose) return "";
  const CellState state = map.at(map.geometry().cell_at(settings.initial_pose->position()));
  if (state == CellState::kFree) return "";
  char text[160];
  (void)std::snprintf(text, sizeof text, "'localization.initial_pose': %g,%g lies %s of the map: is it right?",
                      settings.initial_pose->x, settings.initial_pose->y,
                      state == CellState::kUnknown ? "in the unknown" : "on an occupied cell");
  return text;
}

std::string shift_from_given_pose(const Pose2& first_estimate, const Settings& settings) {
  if (!settings.initial_pose) return "";
  const localization::particles::InitialPose given{*settings.initial_pose};
  const double away_m = distance_between(given.map_from_robot, first_estimate);
  const double turned_rad = std::abs(turn_between(given.map_from_robot.theta, first_estimate.theta));
  if (away_m <= given.position_deviation_m && turned_rad <= given.heading_deviation_rad) return "";
  char text[160];
  (void)std::snprintf(text, sizeof text,
                      "the first estimate lies %.2f m and %.0f degrees from 'localization.initial_pose': is it right?",
                      away_m, degrees(turned_rad));
  return text;
}

LocalizationStep::LocalizationStep(const Settings& settings, const StartMap& start)
    : params_{settings.localizer},
      ignored_{start.site ? start.site->zones : Zones{}, start.map},
      revision_{start.revision},
      localizer_{settings.localizer, ignored_.known(), initial_pose(settings, start), settings.seed},
      fit_watch_{settings.initial_pose.has_value()},
      mount_watch_{settings.localizer.odometry, settings.laser.session.is_upside_down},
      ratio_{settings.mapping.divergence},
      last_map_from_robot_{settings.initial_pose.value_or(start.remembered.value_or(Pose2{}))} {
  if (start.revision > 0)
    localizer_.apply({.number = start.revision, .time = {}, .map = ignored_.known(), .changes = {}, .field_patch = {}});
  if (start.calibration) localizer_.restore(*start.calibration);
  if (start.stability) (void)localizer_.restore(*start.stability);  // refused where its tiles differ: begins anew
  calibration_ = calibration_now_ = localizer_.calibration();
}

void LocalizationStep::observe(const Odometry& odometry) {
  localizer_.observe(odometry);
  mount_watch_.observe(odometry);
  wheel_watch_.observe(odometry);
}

SensorDoubt LocalizationStep::sensor_doubt() const {
  if (mount_watch_.is_told()) return SensorDoubt::kMount;
  if (fit_watch_.is_scale_told()) return SensorDoubt::kScale;
  return wheel_watch_.contradict() ? SensorDoubt::kWheels : SensorDoubt::kNone;
}

TrackedScan LocalizationStep::observe(Scan scan) {
  lines_.clear();
  tell(mount_watch_.observe(scan, wheel_watch_.contradicted_of_late()));
  TrackedScan tracked = localizer_.observe(std::move(scan));
  tracked.estimate.map = ignored_.whole();
  tell(fit_watch_.observe(tracked, {fit(), localizer_.fit_of_all(), localizer_.range_scale()}));
  tell(wheel_watch_.observe(tracked, localizer_.counts().wheels_contradicted));
  tracked.sensor_doubt = sensor_doubt();
  tell_of_ground(tracked.estimate.belief.is_on_new_ground);
  learn_or_forget(tracked);
  last_map_from_robot_ = tracked.estimate.map_from_robot;
  last_odom_from_robot_ = localizer_.odom_from_robot(tracked.scan.time);
  count_time(tracked.scan.time);
  last_state_ = tracked.estimate.state;
  last_verdict_ = tracked.estimate.belief.verdict;
  tracked.weights = ratio_.observe(tracked.estimate);
  row_ = row_of(tracked);
  return tracked;
}

void LocalizationStep::tell(LogLine line) {
  if (!line.text.empty()) lines_.push_back(std::move(line));
}

void LocalizationStep::tell_of_ground(bool is_new) {
  if (is_new == std::exchange(is_on_new_ground_, is_new)) return;
  tell({is_new ? "the robot has left what the map knows: it is drawn as the robot goes and may drift; "
                 "what was known before is left as it is meanwhile"
               : "what the map knew before holds the pose again"});
}

/// Wheels that spin, or are pushed, tell nothing of how they err: what was learned on such a way is forgotten. It may
/// have begun within the metre before, which then showed too little to be sure.
void LocalizationStep::learn_or_forget(const TrackedScan& tracked) {
  if (!calibration_) return;
  if (tracked.stood_m > kSpunM) {
    localizer_.restore(*calibration_);
    calibration_now_ = calibration_;
    since_kept_m_ = 0.0;
    return;
  }
  if (last_odom_from_robot_) since_kept_m_ += distance_between(*last_odom_from_robot_, tracked.odom_from_robot);
  if (since_kept_m_ < kKeptEachM) return;
  since_kept_m_ = 0.0;
  calibration_ = std::exchange(calibration_now_, localizer_.calibration());
}

TrajectoryPoint LocalizationStep::pass_over(const Scan& scan) {
  count_time(scan.time);
  const auto odom_from_robot = localizer_.odom_from_robot(scan.time);
  if (!odom_from_robot || !last_odom_from_robot_) return {scan.time, last_map_from_robot_};
  return {scan.time, last_map_from_robot_ * motion_between(*last_odom_from_robot_, *odom_from_robot)};
}

void LocalizationStep::apply(const MapRevision& revision) {
  revision_ = revision.number;
  localizer_.apply(ignored_.follow(revision, params_));
}

void LocalizationStep::set_zones(const Zones& zones) {
  if (!ignored_.set_zones(zones)) return;
  localizer_.apply({.number = revision_, .time = {}, .map = ignored_.known(), .changes = {}, .field_patch = {}});
}

void LocalizationStep::apply(std::shared_ptr<const TransientObstacles> transients) {
  localizer_.apply(std::move(transients));
}

bool LocalizationStep::relocalize(const Pose2& map_from_robot) {
  if (!localizer_.relocalize(localization::particles::InitialPose{map_from_robot})) return false;
  fit_watch_.relocalized();
  return true;
}

std::map<std::string, std::uint64_t> LocalizationStep::counts() const {
  const localization::LocalizerCounts& c = localizer_.counts();
  return {{"scans", c.scans},
          {"scans_without_return", c.scans_without_return},
          {"scans_without_odometry", c.scans_without_odometry},
          {"wheels_contradicted", c.wheels_contradicted},
          {"clock_fell_back", c.clock_fell_back},
          {"odometry_epochs", c.odometry_epochs},
          {"gaps", c.gaps},
          {"relocalizations", c.relocalizations},
          {"poses_in_obstacle", c.poses_in_obstacle},
          {"poses_refused", c.poses_refused},
          {"poses_confirmed", c.poses_confirmed},
          {"poses_refuted", c.poses_refuted},
          {"searches", c.searches},
          {"recoveries", c.recoveries}};
}

void add_to(RunReport& report, const LocalizationStep& step) {
  report.time_lost_s = step.time_lost_s();
  report.time_global_s = step.time_global_s();
  report.verdict_times = step.verdict_times();
  report.localizer = step.counts();
  report.recorded_s = step.covered_s();
}

double LocalizationStep::covered_s() const { return first_scan_ ? seconds(*last_scan_ - *first_scan_) : 0.0; }

void LocalizationStep::count_time(Timestamp time) {
  if (!first_scan_) first_scan_ = time;
  if (last_scan_) {
    const double passed_s = std::max(0.0, seconds(time - *last_scan_));
    if (last_state_ == LocalizerState::kLost) time_lost_s_ += passed_s;
    if (last_state_ == LocalizerState::kGlobal) time_global_s_ += passed_s;
    if (last_verdict_ == PoseVerdict::kRight) verdict_times_.right_s += passed_s;
    if (last_verdict_ == PoseVerdict::kUndecided) verdict_times_.undecided_s += passed_s;
    if (last_verdict_ == PoseVerdict::kWrong) verdict_times_.wrong_s += passed_s;
  }
  last_scan_ = time;
}

}  // namespace deltamap::daemon
