// SPDX-License-Identifier: Apache-2.0
// Two drives, from two places, through a building of `unseen` in which nothing is moved: what a first map is made of.
#pragma once

#include <cstdint>
#include <functional>

#include "simulation/virtual_drive.hpp"

namespace deltamap::experiments {

struct CalmDrives {
  std::function<void(simulation::DriveStep&&)> step;
  /// In place of `step`, in the middle: the robot has been put elsewhere.
  std::function<void(simulation::DriveStep&&)> begin_second;
};

/// `minutes`: both drives together.
void drive_calmly(std::uint64_t seed, double minutes, const CalmDrives& drives);

}  // namespace deltamap::experiments
