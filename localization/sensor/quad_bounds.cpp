// SPDX-License-Identifier: Apache-2.0
// Compiled with -O3: sixteen quads side by side are summed up by a few instructions (SSE2).
#include "localization/sensor/quad_bounds.hpp"

namespace deltamap::localization::sensor {

QuadBounds::QuadBounds(int columns, int rows, std::uint8_t unknown)
    : columns_{columns},
      rows_{rows},
      bytes_(std::size_t{2} * static_cast<std::size_t>(padded_rows()) * static_cast<std::size_t>(padded_columns()),
             unknown) {}

std::array<std::uint16_t, QuadBounds::kAtOnce> QuadBounds::bounds(const TurnedBeams& beams, int column, int row) const {
  std::array<std::int32_t, TurnedBeams::kMost> places;
  for (std::size_t i = 0; i < places.size(); ++i) {
    const int x = std::clamp(column + (beams.columns[i] >> 1), -kBefore, columns());
    const int y = std::clamp(2 * row + beams.rows[i], -2, rows_);
    places[i] = ((beams.columns[i] & 1) * padded_rows() + y + 2) * padded_columns() + x + kBefore;
  }
  std::array<std::uint16_t, kAtOnce> sums{};
  for (std::size_t beam = 0; beam < beams.count; ++beam) {
    const std::uint8_t* const steps = bytes_.data() + places[beam];
    for (std::size_t i = 0; i < sums.size(); ++i) sums[i] = static_cast<std::uint16_t>(sums[i] + steps[i]);
  }
  return sums;
}

}  // namespace deltamap::localization::sensor
