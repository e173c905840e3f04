// SPDX-License-Identifier: Apache-2.0
#include "localization/sensor/turned_beams.hpp"

#include <algorithm>
#include <cmath>

namespace deltamap::localization::sensor {

TurnedBeams turned_beams(const motion::BeamEnds& ends, double heading_rad, double block_m) {
  TurnedBeams beams;
  beams.count = std::min(ends.size(), TurnedBeams::kMost);
  const double c = std::cos(heading_rad) / block_m;
  const double s = std::sin(heading_rad) / block_m;
  const auto whole = [](double blocks) {
    constexpr double kFarthest = TurnedBeams::kFarthest;
    return static_cast<std::int16_t>(std::clamp(std::floor(blocks + 0.5), -kFarthest, kFarthest));
  };
  for (std::size_t i = 0; i < beams.count; ++i) {
    const std::size_t from = i * ends.size() / beams.count;
    const auto x_m = static_cast<double>(ends.x_m[from]);
    const auto y_m = static_cast<double>(ends.y_m[from]);
    beams.columns[i] = whole(c * x_m - s * y_m);
    beams.rows[i] = whole(s * x_m + c * y_m);
  }
  return beams;
}

}  // namespace deltamap::localization::sensor
