// SPDX-License-Identifier: Apache-2.0
#include "localization/sensor/coarse_field.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "tests/support/scans/cast_ends.hpp"
#include "tests/support/worlds/drawn_flat.hpp"
#include "tests/support/worlds/padded.hpp"

namespace deltamap::localization::sensor {
namespace {

constexpr double kBlock_m = 0.25;

TEST(CoarseField, IsAsGoodInEachBlockAsItsBestCell) {
  const OccupancyGrid map = test::drawn_flat();
  const LikelihoodField field{map, {}};
  const CoarseField coarse{map, field, kBlock_m};
  const int cells = 5;
  const Point2 middle_of_a_cell = Point2::Constant(0.5 * map.resolution_m());
  const Cell first = map.geometry().cell_at(coarse.origin() + middle_of_a_cell);
  for (int row = 0; row < coarse.rows(); ++row) {
    for (int column = 0; column < coarse.columns(); ++column) {
      int best = 255;
      for (int i = 0; i < cells * cells; ++i) {
        const Cell cell{first.column + column * cells + i % cells, first.row + row * cells + i / cells};
        best = std::min<int>(best, field.steps_at(cell));
      }
      ASSERT_EQ(*coarse.from(column, row), best) << column << ' ' << row;
    }
  }
}

TEST(CoarseField, FindsTheFreeBlocksOfARowBetweenTwoPlaces) {
  const OccupancyGrid map = test::drawn_flat();
  const CoarseField coarse{map, LikelihoodField{map, {}}, kBlock_m};
  const double from_m = 3.1;
  const double to_m = 6.4;
  for (int row = 0; row < coarse.rows(); ++row) {
    const CoarseField::Run run = coarse.free_in_row(row, from_m, to_m);
    for (std::size_t i = 0; i < coarse.free_blocks().size(); ++i) {
      const Point2 middle = coarse.centre_of(coarse.free_blocks()[i]);
      const bool lies_between =
          std::abs(middle.y() - coarse.middle_of_row(row)) < 1e-9 && middle.x() >= from_m && middle.x() < to_m;
      EXPECT_EQ(i >= run.first && i < run.past, lies_between) << row << ' ' << middle.x();
    }
    const CoarseField::Run all = coarse.free_in_row(row, -1e6, 1e6);
    EXPECT_LE(all.first, run.first);
    EXPECT_GE(all.past, run.past);
    const CoarseField::Run beyond = coarse.free_in_row(row, 1e6, 2e6);
    EXPECT_EQ(beyond.first, beyond.past);
  }
}

TEST(CoarseField, FollowsAChangeOfTheMapAsIfBuiltAnew) {
  const OccupancyGrid before = test::drawn_flat();
  OccupancyGrid after = before;
  test::fill_box(after, {4.0, 1.0}, {5.1, 1.7}, CellState::kOccupied);
  CoarseField patched{before, LikelihoodField{before, {}}, kBlock_m};
  const LikelihoodField field{after, {}};
  patched.update(after, field, field_patch(after, changes_between(before, after), {}).box);
  const CoarseField built{after, field, kBlock_m};
  for (int row = -1; row <= built.rows(); ++row) {
    const std::uint8_t* const expected = built.from(0, row);
    EXPECT_TRUE(std::equal(expected, expected + built.columns(), patched.from(0, row))) << row;
  }
  EXPECT_TRUE(std::ranges::equal(built.free_blocks(), patched.free_blocks()));
  EXPECT_LT(patched.free_blocks().size(), CoarseField(before, field, kBlock_m).free_blocks().size());
}

TEST(CoarseField, IsTheSameHoweverMuchUnknownSpaceLiesAroundTheMap) {
  const OccupancyGrid map = test::drawn_flat();
  const CoarseField own{map, LikelihoodField{map, {}}, kBlock_m};
  const OccupancyGrid padded_map = test::padded(map, {.left = 1213, .low = 7, .right = 1, .high = 902});
  const CoarseField wide{padded_map, LikelihoodField{padded_map, {}}, kBlock_m};
  ASSERT_EQ(wide.columns(), own.columns());
  ASSERT_TRUE(std::ranges::equal(wide.free_blocks(), own.free_blocks()));
  EXPECT_NEAR((wide.origin() - own.origin()).norm(), 0.0, 1e-9);
  for (int row = -1; row <= own.rows(); ++row)
    EXPECT_TRUE(std::equal(own.from(0, row), own.from(0, row) + own.columns(), wide.from(0, row))) << row;
}

TEST(CoarseField, TakesBeamsThatLeaveTheMapAsEndingInTheUnknown) {
  const OccupancyGrid map = test::drawn_flat();
  const LikelihoodField field{map, {}};
  const CoarseField coarse{map, field, kBlock_m};
  const motion::BeamEnds far{{1000.0F, 5000.0F, 9e9F}, {0.0F, -3000.0F, 1.0F}};
  const CoarseMisfits misfits = coarse_misfits(coarse, turned_beams(far, 1.0, kBlock_m), coarse.free_blocks()[7]);
  for (const std::uint16_t misfit : misfits) EXPECT_EQ(misfit, 3 * field.steps_at({-1, -1}));
}

TEST(CoarseField, AnswersForBlocksSideBySideAsForEachAlone) {
  const OccupancyGrid map = test::drawn_flat();
  const LikelihoodField field{map, {}};
  const CoarseField coarse{map, field, kBlock_m};
  Random random{3};
  const TurnedBeams beams = turned_beams(test::cast_ends(map, {4.5, 2.0, 1.1}, {}, random, 60), 0.7, kBlock_m);
  for (const std::uint32_t first : coarse.free_blocks()) {
    const CoarseMisfits misfits = coarse_misfits(coarse, beams, first);
    const int row = static_cast<int>(first) / coarse.columns();
    for (int i = 0; i < CoarseField::kAtOnce; ++i) {
      const int column = static_cast<int>(first) % coarse.columns() + i;
      if (column >= coarse.columns()) break;
      int sum = 0;
      for (std::size_t beam = 0; beam < beams.count; ++beam) {
        sum += *coarse.from(column + beams.columns[beam], row + beams.rows[beam]);
      }
      ASSERT_EQ(misfits[static_cast<std::size_t>(i)], sum) << column << ' ' << row;
    }
  }
}

}  // namespace
}  // namespace deltamap::localization::sensor
