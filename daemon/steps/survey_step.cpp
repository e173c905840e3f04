// SPDX-License-Identifier: Apache-2.0
#include "daemon/steps/survey_step.hpp"

#include <utility>

#include "localization/motion/deskew.hpp"

namespace deltamap::daemon {
namespace {

constexpr double kMostUncoveredS = 1.0;  // between a scan and the nearest report of the wheels

}  // namespace

SurveyStep::SurveyStep(const Settings& settings)
    : odometry_params_{settings.localizer.odometry},
      range_deviation_m_{settings.localizer.range_deviation_m},
      odometry_{odometry_params_} {}

void SurveyStep::begin_drive() {
  odometry_ = localization::motion::OdometryBuffer{odometry_params_};
  slam_.begin_drive();
}

bool SurveyStep::observe(Scan scan) {
  if (!scans_.empty() && scan.time < scans_.back().time) odometry_.clock_fell_back(scans_.back().time);
  const auto wheels = odometry_.at(scan.time);
  if (!wheels || wheels->uncovered_s > kMostUncoveredS) return false;
  TrackedScan tracked;
  scan.range_deviation_m = range_deviation_m_;
  tracked.rays = localization::motion::deskewed(scan, odometry_.velocity_at(scan.time));
  tracked.odom_from_robot = wheels->continuous_odom_from_robot;
  tracked.odometry_epoch = wheels->epoch;
  const Timestamp time = scan.time;
  tracked.scan = std::move(scan);
  slam_.observe(std::move(tracked));
  const auto& keyframes = slam_.survey().keyframes;
  scans_.push_back({time, static_cast<std::uint32_t>(keyframes.size() - 1),
                    motion_between(keyframes.back().tracked->odom_from_robot, wheels->continuous_odom_from_robot)});
  return true;
}

std::vector<TrajectoryPoint> SurveyStep::trajectory() const {
  std::vector<TrajectoryPoint> points;
  points.reserve(scans_.size());
  for (const SurveyedScan& scan : scans_) {
    points.push_back({scan.time, slam_.survey().poses[scan.keyframe] * scan.keyframe_from_robot});
  }
  return points;
}

}  // namespace deltamap::daemon
