// SPDX-License-Identifier: Apache-2.0
// Compiled with -O3: the first of the two loops becomes four beams an instruction (SSE2), or eight where the processor
// has AVX2, which the loader finds out. Neither contracts or reorders floating point: both answer the same.
#include "localization/sensor/weighing.hpp"

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <limits>

// The sanitizers cannot bear the loader's choosing.
#if defined(__x86_64__) && !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)
#define DELTAMAP_ALSO_FOR_AVX2 [[gnu::target_clones("avx2", "default")]]
#else
#define DELTAMAP_ALSO_FOR_AVX2
#endif

namespace deltamap::localization::sensor {
namespace {

constexpr std::size_t kBlock = 64;  // ends whose cells are found before their bytes are read

/// A pose in cells of the bordered field.
struct PoseInCells {
  float x, y, c, s;
};

/// Calls `take` with the field's bytes and, for a block of ends after the other, their places among them.
template <typename Take>
[[gnu::always_inline]] inline void for_each_block(const LikelihoodField& field, const motion::BeamEnds& ends,
                                                  const Pose2& map_from_robot, Take&& take) {
  const LikelihoodField::Bordered bordered = field.bordered();
  const double cells_per_m = 1.0 / field.geometry().resolution_m;
  const auto heading_rad = static_cast<float>(map_from_robot.theta);
  const PoseInCells pose{static_cast<float>((map_from_robot.x - bordered.origin.x()) * cells_per_m + 1.0),
                         static_cast<float>((map_from_robot.y - bordered.origin.y()) * cells_per_m + 1.0),
                         std::cos(heading_rad) * static_cast<float>(cells_per_m),
                         std::sin(heading_rad) * static_cast<float>(cells_per_m)};
  const auto last_column = static_cast<float>(bordered.width - 1);
  const auto last_row = static_cast<float>(bordered.height - 1);

  assert(static_cast<std::int64_t>(bordered.width) * bordered.height <= std::numeric_limits<std::int32_t>::max() &&
         "a cell's place must fit 32 bits");
  std::array<std::int32_t, kBlock> cells;
  for (std::size_t start = 0; start < ends.size(); start += kBlock) {
    const std::size_t count = std::min(kBlock, ends.size() - start);
    const float* const x_m = ends.x_m.data() + start;
    const float* const y_m = ends.y_m.data() + start;
    for (std::size_t i = 0; i < count; ++i) {
      const float x = pose.x + (pose.c * x_m[i] - pose.s * y_m[i]);
      const float y = pose.y + (pose.s * x_m[i] + pose.c * y_m[i]);
      const float x_up = x > 0.0F ? x : 0.0F;
      const float y_up = y > 0.0F ? y : 0.0F;
      const auto column = static_cast<std::int32_t>(x_up < last_column ? x_up : last_column);
      const auto row = static_cast<std::int32_t>(y_up < last_row ? y_up : last_row);
      cells[i] = row * bordered.width + column;
    }
    take(bordered.bytes, std::span{cells.data(), count});
  }
}

/// Calls `take` with the field's byte at each end.
template <typename Take>
[[gnu::always_inline]] inline void for_each_byte(const LikelihoodField& field, const motion::BeamEnds& ends,
                                                 const Pose2& map_from_robot, Take&& take) {
  for_each_block(field, ends, map_from_robot, [&](const std::uint8_t* bytes, std::span<const std::int32_t> cells) {
    for (const std::int32_t cell : cells) take(bytes[cell]);
  });
}

}  // namespace

DELTAMAP_ALSO_FOR_AVX2
std::int32_t misfit_steps(const LikelihoodField& field, const motion::BeamEnds& ends, const Pose2& map_from_robot) {
  std::int32_t sum = 0;
  for_each_byte(field, ends, map_from_robot, [&](std::uint8_t steps) { sum += steps; });
  return sum;
}

DELTAMAP_ALSO_FOR_AVX2
SegmentedMisfit segmented_misfit(const LikelihoodField& field, const motion::BeamEnds& ends,
                                 std::span<const ScanSegment> segments, std::int32_t most,
                                 const Pose2& map_from_robot) {
  if (segments.empty()) {
    const std::int32_t sum = misfit_steps(field, ends, map_from_robot);
    return {sum, sum};
  }
  std::array<std::int32_t, kBlock + 1> before;  // sums of the ends before each of the block
  std::int32_t sum = 0;
  std::int32_t beyond = 0;
  std::int32_t before_segment = 0;
  std::size_t start = 0;  // of the block
  auto segment = segments.begin();
  for_each_block(field, ends, map_from_robot, [&](const std::uint8_t* bytes, std::span<const std::int32_t> cells) {
    for (std::size_t i = 0; i < cells.size(); ++i) {
      before[i] = sum;
      sum += bytes[cells[i]];
    }
    before[cells.size()] = sum;
    const std::size_t past = start + cells.size();
    for (; segment != segments.end() && segment->first < past; ++segment) {
      if (segment->first >= start) before_segment = before[segment->first - start];
      if (segment->past > past) break;
      beyond += std::max(0, before[segment->past - start] - before_segment - most);
    }
    start = past;
  });
  return {sum, sum - beyond};
}

double explained_share(const LikelihoodField& field, const motion::BeamEnds& ends, const Pose2& map_from_robot) {
  if (ends.size() == 0) return 0.0;
  const std::uint8_t even_steps = field.even_steps();
  int explained = 0;
  for_each_byte(field, ends, map_from_robot, [&](std::uint8_t steps) { explained += steps < even_steps ? 1 : 0; });
  return explained / static_cast<double>(ends.size());
}

double mean_likelihood(std::int64_t steps, std::size_t beams) {
  assert(beams > 0 && "a mean needs a beam");
  return std::exp(-LikelihoodField::kStep * static_cast<double>(steps) / static_cast<double>(beams));
}

}  // namespace deltamap::localization::sensor
