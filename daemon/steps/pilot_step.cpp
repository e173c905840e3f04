// SPDX-License-Identifier: Apache-2.0
#include "daemon/steps/pilot_step.hpp"

#include <algorithm>
#include <utility>

#include "navigation/mapped_walls.hpp"
#include "navigation/remembered_obstacles.hpp"

namespace deltamap::daemon {
namespace {

constexpr double kMappedWithinM = 3.0;  // walls that the laser does not see: as far as it remembers other things

constexpr double kSpinsForM = 0.3;  // claimed by the wheels of a robot that stands

}  // namespace

PilotStep::PilotStep(const Settings& settings, Zones zones)
    : drives_without_pose_{settings.navigation.drive_without_pose}, zones_{std::move(zones)} {
  if (settings.navigation.mode == navigation::DriveMode::kWander) {
    wander_.emplace(settings.navigation.wander, settings.seed);
  }
}

void PilotStep::set_params(const navigation::WanderParams& params) {
  if (wander_) wander_->set_params(params);
}

PilotWord PilotStep::observe(const TrackedScan& tracked, const Seen& seen) {
  using navigation::StopReason;
  PilotWord word;
  word.command.time = tracked.scan.time;
  word.pose = pose_watch_.observe({tracked.estimate, seen.fit, seen.start_fits});
  word.wheels_spin = tracked.stood_m > kSpinsForM;
  if (std::exchange(times_let_drive_, seen.times_let_drive) != seen.times_let_drive) dead_beams_.begin_anew();
  dead_beams_.observe(tracked.scan);
  if (word.pose == StopReason::kNone) dead_beams_.hold_against_map(tracked);
  word.misses_walls = dead_beams_.hide_a_sector();
  word.held_by = drives_without_pose_ ? StopReason::kNone : word.pose;
  word.expects_no_range = word.pose == StopReason::kNone && navigation::expects_no_range(tracked);
  if (word.pose == StopReason::kNone)
    word.zones = navigation::zones_around(zones_, tracked.estimate.map_from_robot, tracked.scan.time);
  if (wander_ && word.held_by == StopReason::kNone)
    word.command = wander_->step(tracked, obstacles_beside(tracked, seen, word.zones));
  return word;
}

std::vector<Point2> PilotStep::obstacles_beside(const TrackedScan& tracked, const Seen& seen,
                                                const navigation::ZonesAround& zones) const {
  std::vector<Point2> obstacles = navigation::walls_behind_lost_beams(tracked, kMappedWithinM);
  obstacles.insert(obstacles.end(), zones.blocked_in_robot.begin(), zones.blocked_in_robot.end());
  if (seen.transients == nullptr) return obstacles;
  const auto remembered =
      navigation::remembered_obstacles(*seen.transients, tracked, {.hull_m = wander_->params().robot_radius_m});
  obstacles.insert(obstacles.end(), remembered.begin(), remembered.end());
  return obstacles;
}

}  // namespace deltamap::daemon
