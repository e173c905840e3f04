// SPDX-License-Identifier: Apache-2.0
// A few beams of a scan turned to one heading, as whole blocks from the block that the robot stands in.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "localization/motion/deskew.hpp"

namespace deltamap::localization::sensor {

struct TurnedBeams {
  static constexpr std::size_t kMost = 32;
  static constexpr std::int16_t kFarthest = 16000;  ///< blocks; the border of every map is nearer
  std::array<std::int16_t, kMost> columns{};
  std::array<std::int16_t, kMost> rows{};
  std::size_t count = 0;
};

[[nodiscard]] TurnedBeams turned_beams(const motion::BeamEnds& ends, double heading_rad, double block_m);

}  // namespace deltamap::localization::sensor
