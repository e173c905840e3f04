// SPDX-License-Identifier: Apache-2.0
// A hall of large containers that are pushed about: blocks of four, 5 m each, with aisles between, and every minute one
// of them is shifted by up to 0.8 m in x and in y. From within an aisle, with a laser of 8 m, shifted containers may be
// all that is in view. Wheels are poorly calibrated.
#pragma once

#include <cstdint>

#include "simulation/drawn/drawn.hpp"

namespace deltamap::simulation::drawn {

/// What makes it harder.
struct ShiftedHallParams {
  double range_m = 8.0;            ///< of the laser
  bool slips = false;              ///< 0.3 m or 0.15 rad every 30 m
  double wheel_noise_times = 1.0;  ///< of the delivered robot's, >= 0
  bool crowd = false;              ///< 12 people in place of 3, and 60 boxes that no map shows
  double largest_turn_rad = 0.0;   ///< of a container that is shifted, >= 0
};

/// By the seed alone: where everything stands, who walks where, and what happens.
[[nodiscard]] Drawn shifted_hall(const ShiftedHallParams& params, std::uint64_t seed);

}  // namespace deltamap::simulation::drawn
