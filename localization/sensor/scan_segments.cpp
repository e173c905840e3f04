// SPDX-License-Identifier: Apache-2.0
#include "localization/sensor/scan_segments.hpp"

#include <algorithm>
#include <cmath>

namespace deltamap::localization::sensor {
namespace {

constexpr float kApartM = 0.4F;  // two ends of one thing lie no further apart: wider than the gaps of its own beams

float distance_m(const motion::BeamEnds& ends, std::size_t from, std::size_t to) {
  return std::hypot(ends.x_m[to] - ends.x_m[from], ends.y_m[to] - ends.y_m[from]);
}

}  // namespace

std::vector<ScanSegment> segmented(const motion::BeamEnds& ends, std::size_t fewest,
                                   std::vector<ScanSegment> segments) {
  segments.clear();
  std::size_t first = 0;
  for (std::size_t i = 1; i <= ends.size(); ++i) {
    const bool goes_on =
        i < ends.size() && distance_m(ends, i - 1, i) <= kApartM && distance_m(ends, first, i) <= kMovesAsOneM;
    if (goes_on) continue;
    if (i - first >= fewest) segments.push_back({static_cast<std::uint32_t>(first), static_cast<std::uint32_t>(i)});
    first = i;
  }
  return segments;
}

SegmentBound segment_bound(const LikelihoodFieldParams& params, double hit_deviation_m, double of_a_beam) {
  const double nats = -std::log(1.0 - kUsuallyHolds) + std::log(kMovedM / hit_deviation_m);
  const double of_a_beam_at_most = -of_a_beam * std::log(params.random_share);
  return {.steps = static_cast<std::int32_t>(nats / (of_a_beam * LikelihoodField::kStep)),
          .fewest = static_cast<std::size_t>(std::max(0.0, nats / of_a_beam_at_most)) + 1};
}

}  // namespace deltamap::localization::sensor
