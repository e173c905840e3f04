// SPDX-License-Identifier: Apache-2.0
#include "localization/sensor/quad_bounds.hpp"

#include <gtest/gtest.h>

#include <algorithm>

#include "localization/sensor/coarse_field.hpp"
#include "tests/support/scans/cast_ends.hpp"
#include "tests/support/worlds/drawn_flat.hpp"

namespace deltamap::localization::sensor {
namespace {

constexpr double kBlockM = 0.25;

/// Of a quad, by its blocks one by one.
int bound_of(const CoarseField& coarse, const TurnedBeams& beams, int column, int row) {
  int sum = 0;
  for (std::size_t beam = 0; beam < beams.count; ++beam) {
    const int x = 2 * column + beams.columns[beam];
    const int y = 2 * row + beams.rows[beam];
    sum += std::min(std::min(*coarse.from(x, y), *coarse.from(x + 1, y)),
                    std::min(*coarse.from(x, y + 1), *coarse.from(x + 1, y + 1)));
  }
  return sum;
}

void expect_bounds_of_blocks(const CoarseField& coarse, const TurnedBeams& beams) {
  for (const CoarseField::Quad& quad : coarse.free_quads()) {
    const auto bounds = coarse.quads().bounds(beams, quad.column, quad.row);
    for (int i = 0; i < QuadBounds::kAtOnce && quad.column + i < coarse.quads().columns(); ++i) {
      ASSERT_EQ(bounds[static_cast<std::size_t>(i)], bound_of(coarse, beams, quad.column + i, quad.row))
          << quad.column + i << ' ' << quad.row;
    }
  }
}

TEST(QuadBounds, AreTheBestThatAnyOfFourBlocksMayAnswer) {
  const OccupancyGrid before = test::drawn_flat();
  CoarseField coarse{before, LikelihoodField{before, {}}, kBlockM};
  Random random{3};
  const TurnedBeams seen = turned_beams(test::cast_ends(before, {4.5, 2.0, 1.1}, {}, random, 60), 0.7, kBlockM);
  const TurnedBeams far = turned_beams({{1000.0F, -5000.0F, 9e9F}, {0.0F, -3000.0F, 1.0F}}, 1.0, kBlockM);
  expect_bounds_of_blocks(coarse, seen);
  expect_bounds_of_blocks(coarse, far);
  OccupancyGrid after = before;
  test::fill_box(after, {4.0, 1.0}, {5.1, 1.7}, CellState::kOccupied);
  coarse.update(after, LikelihoodField{after, {}}, field_patch(after, changes_between(before, after), {}).box);
  expect_bounds_of_blocks(coarse, seen);
}

}  // namespace
}  // namespace deltamap::localization::sensor
