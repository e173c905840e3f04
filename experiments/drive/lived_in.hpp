// SPDX-License-Identifier: Apache-2.0
// A place where the robot has been at work for a while: what its localizer has learned to be stable. Driven once, by
// whichever run asks first; all others wait for it.
#pragma once

#include <mutex>

#include "experiments/drive/mapping_drive.hpp"

namespace deltamap::experiments {

struct LivedInParams {
  std::uint64_t seed = 1;
  double minutes = 60.0;         ///< of driving, > 0
  double change_every_s = 60.0;  ///< of the fork-lift, > 0; the paper's (§4)
  double max_range_m = 80.0;
};

/// What a fork-lift does where it must be ready for anything.
[[nodiscard]] simulation::ForkliftParams busy_forklift(double change_every_s);

/// Three who walk about the corridors of a hall that has nobody in it.
[[nodiscard]] std::vector<simulation::PersonParams> walkers();

class LivedIn {
 public:
  LivedIn(const simulation::Scenario& scenario, std::vector<simulation::PersonParams> people,
          const localization::LocalizerParams& localizer, std::shared_ptr<const OccupancyGrid> map,
          const LivedInParams& params);

  [[nodiscard]] const localization::belief::StabilityRecord& stability();
  /// Tiles of the map that have proven to stay.
  [[nodiscard]] std::size_t proven_tiles();

 private:
  void drive();

  simulation::Scenario scenario_;
  std::vector<simulation::PersonParams> people_;
  localization::LocalizerParams localizer_;
  std::shared_ptr<const OccupancyGrid> map_;
  LivedInParams params_;
  std::once_flag driven_;
  localization::belief::StabilityRecord stability_;
};

}  // namespace deltamap::experiments
