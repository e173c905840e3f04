// SPDX-License-Identifier: Apache-2.0
#include "experiments/drive/lived_in.hpp"

#include <utility>

#include "localization/belief/stability.hpp"

namespace deltamap::experiments {

simulation::ForkliftParams busy_forklift(double change_every_s) {
  simulation::ForkliftParams forklift;
  forklift.change_every_s = change_every_s;
  forklift.kinds = {simulation::ChangeKind::kRemoved, simulation::ChangeKind::kAdded, simulation::ChangeKind::kShifted};
  forklift.least_filled = 0.3;
  return forklift;
}

std::vector<simulation::PersonParams> walkers() {
  simulation::PersonParams upright{.path = {{16.2, 2.0}, {16.2, 33.0}}, .speed_m_per_s = 1.2};
  simulation::PersonParams level{.path = {{2.0, 18.8}, {33.0, 18.8}}, .speed_m_per_s = 1.0};
  simulation::PersonParams round{
      .path = {{3.6, 3.6}, {31.4, 3.6}, {31.4, 30.0}, {3.6, 31.4}}, .closed = true, .speed_m_per_s = 1.3};
  return {upright, level, round};
}

LivedIn::LivedIn(const simulation::Scenario& scenario, std::vector<simulation::PersonParams> people,
                 const localization::LocalizerParams& localizer, std::shared_ptr<const OccupancyGrid> map,
                 const LivedInParams& params)
    : scenario_{scenario}, people_{std::move(people)}, localizer_{localizer}, map_{std::move(map)}, params_{params} {}

const localization::belief::StabilityRecord& LivedIn::stability() {
  std::call_once(driven_, [this] { drive(); });
  return stability_;
}

std::size_t LivedIn::proven_tiles() {
  localization::belief::Stability learned{map_->geometry()};
  return learned.restore(stability()) ? learned.proven_tiles() : 0;
}

void LivedIn::drive() {
  simulation::VirtualDriveParams drive;
  drive.seed = params_.seed;
  drive.max_range_m = params_.max_range_m;
  drive.people = people_;
  drive.forklift = busy_forklift(params_.change_every_s);
  MappingDrive robot{scenario_, drive, localizer_alone(localizer_), {map_}};
  while (robot.next().passed_s < 60.0 * params_.minutes) {
  }
  stability_ = robot.localization().stability();
}

}  // namespace deltamap::experiments
