// SPDX-License-Identifier: Apache-2.0
#include "daemon/steps/survey_step.hpp"

#include <utility>

namespace deltamap::daemon {

SurveyStep::SurveyStep(const Settings& settings)
    : odometry_params_{settings.localizer.odometry}, range_deviation_m_{settings.localizer.range_deviation_m} {}

void SurveyStep::begin_drive() {
  (void)end_drive();
  scans_before_ = scans_.size();
  odometry_.emplace(odometry_params_, range_deviation_m_,
                    [this](surveying::slam::MovedScan&& moved) { take(std::move(moved)); });
  slam_.begin_drive();
}

std::size_t SurveyStep::end_drive() {
  if (odometry_) odometry_->end();
  odometry_.reset();
  return scans_.size() - scans_before_;
}

bool SurveyStep::finish() {
  (void)end_drive();
  return slam_.finish();
}

void SurveyStep::take(surveying::slam::MovedScan&& moved) {
  const Timestamp time = moved.tracked.scan.time;
  const Pose2 start_from_robot = moved.tracked.odom_from_robot;
  slam_.observe(moved);
  const auto& keyframes = slam_.survey().keyframes;
  scans_.push_back({time, static_cast<std::uint32_t>(keyframes.size() - 1),
                    motion_between(keyframes.back().odom_from_robot, start_from_robot)});
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
