// SPDX-License-Identifier: Apache-2.0
#include "experiments/drive/localizer_drive.hpp"

#include <utility>

#include "simulation/start_map.hpp"

namespace deltamap::experiments {

LocalizerDrive::LocalizerDrive(const simulation::Scenario& scenario, const simulation::VirtualDriveParams& drive,
                               const localization::LocalizerParams& localizer, std::shared_ptr<const OccupancyGrid> map,
                               std::optional<localization::InitialPose> initial_pose)
    : drive_{scenario, drive}, localizer_{localizer, std::move(map), initial_pose, drive.seed} {}

Followed LocalizerDrive::next() {
  simulation::DriveStep step = drive_.next();
  if (!first_) first_ = step.scan.time;
  const double passed_s = seconds(step.scan.time - *first_);
  for (const Odometry& odometry : step.odometry) localizer_.observe(odometry);
  tracked_ = localizer_.observe(std::move(step.scan));
  return {step.map_from_robot, tracked_.estimate, std::move(step.changes), passed_s};
}

std::shared_ptr<const OccupancyGrid> first_map(const simulation::Scenario& scenario) {
  constexpr double kResolution_m = 0.05;
  return std::make_shared<const OccupancyGrid>(simulation::start_map(scenario, kResolution_m));
}

PoseError error_of(const Followed& scan) {
  const Pose2& estimate = scan.estimate.map_from_robot;
  return {estimate.position() - scan.map_from_robot.position(),
          turn_between(scan.map_from_robot.theta, estimate.theta)};
}

}  // namespace deltamap::experiments
