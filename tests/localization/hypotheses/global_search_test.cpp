// SPDX-License-Identifier: Apache-2.0
#include "localization/hypotheses/global_search.hpp"

#include <gtest/gtest.h>

#include "localization/sensor/weighing.hpp"
#include "tests/support/scans/cast_ends.hpp"
#include "tests/support/worlds/drawn_flat.hpp"
#include "tests/support/worlds/padded.hpp"

namespace deltamap::localization::hypotheses {
namespace {

constexpr double kBlock_m = 0.25;
constexpr int kHeadings = 48;

motion::BeamEnds seen_from(const Pose2& truth, std::uint64_t seed) {
  Random random{seed};
  return test::cast_ends(test::drawn_flat(), truth, {}, random, 60);
}

bool very_near(const Pose2& a, const Pose2& b) {
  return distance_between(a, b) < 0.1 && std::abs(turn_between(a.theta, b.theta)) < radians(3.0);
}

TEST(CoarseField, IsAsGoodInEachBlockAsItsBestCell) {
  const OccupancyGrid map = test::drawn_flat();
  const sensor::LikelihoodField field{map, {}};
  const sensor::CoarseField coarse{map, field, kBlock_m};
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

TEST(CoarseField, FollowsAChangeOfTheMapAsIfBuiltAnew) {
  const OccupancyGrid before = test::drawn_flat();
  OccupancyGrid after = before;
  test::fill_box(after, {4.0, 1.0}, {5.1, 1.7}, CellState::kOccupied);
  sensor::CoarseField patched{before, sensor::LikelihoodField{before, {}}, kBlock_m};
  const sensor::LikelihoodField field{after, {}};
  patched.update(after, field, sensor::field_patch(after, changes_between(before, after), {}).box);
  const sensor::CoarseField built{after, field, kBlock_m};
  for (int row = -1; row <= built.rows(); ++row) {
    const std::uint8_t* const expected = built.from(0, row);
    EXPECT_TRUE(std::equal(expected, expected + built.columns(), patched.from(0, row))) << row;
  }
  EXPECT_TRUE(std::ranges::equal(built.free_blocks(), patched.free_blocks()));
  EXPECT_LT(patched.free_blocks().size(), sensor::CoarseField(before, field, kBlock_m).free_blocks().size());
}

TEST(CoarseField, IsTheSameHoweverMuchUnknownSpaceLiesAroundTheMap) {
  const OccupancyGrid map = test::drawn_flat();
  const sensor::CoarseField own{map, sensor::LikelihoodField{map, {}}, kBlock_m};
  const OccupancyGrid padded_map = test::padded(map, {.left = 1213, .low = 7, .right = 1, .high = 902});
  const sensor::CoarseField wide{padded_map, sensor::LikelihoodField{padded_map, {}}, kBlock_m};
  ASSERT_EQ(wide.columns(), own.columns());
  ASSERT_TRUE(std::ranges::equal(wide.free_blocks(), own.free_blocks()));
  EXPECT_NEAR((wide.origin() - own.origin()).norm(), 0.0, 1e-9);
  for (int row = -1; row <= own.rows(); ++row)
    EXPECT_TRUE(std::equal(own.from(0, row), own.from(0, row) + own.columns(), wide.from(0, row))) << row;
}

TEST(CoarseField, TakesBeamsThatLeaveTheMapAsEndingInTheUnknown) {
  const OccupancyGrid map = test::drawn_flat();
  const sensor::LikelihoodField field{map, {}};
  const sensor::CoarseField coarse{map, field, kBlock_m};
  const motion::BeamEnds far{{1000.0F, 5000.0F, 9e9F}, {0.0F, -3000.0F, 1.0F}};
  const sensor::CoarseMisfits misfits =
      sensor::coarse_misfits(coarse, sensor::turned_beams(far, 1.0, kBlock_m), coarse.free_blocks()[7]);
  for (const std::uint16_t misfit : misfits) EXPECT_EQ(misfit, 3 * field.steps_at({-1, -1}));
}

TEST(CoarseField, AnswersForBlocksSideBySideAsForEachAlone) {
  const OccupancyGrid map = test::drawn_flat();
  const sensor::LikelihoodField field{map, {}};
  const sensor::CoarseField coarse{map, field, kBlock_m};
  const sensor::TurnedBeams beams = sensor::turned_beams(seen_from({4.5, 2.0, 1.1}, 3), 0.7, kBlock_m);
  for (const std::uint32_t first : coarse.free_blocks()) {
    const sensor::CoarseMisfits misfits = sensor::coarse_misfits(coarse, beams, first);
    const int row = static_cast<int>(first) / coarse.columns();
    for (int i = 0; i < sensor::CoarseField::kAtOnce; ++i) {
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

TEST(GlobalSearch, FindsTheRobotFromManyHypothesesInItsFirstLook) {
  const OccupancyGrid map = test::drawn_flat();
  const sensor::LikelihoodField field{map, {}};
  const sensor::CoarseField coarse{map, field, kBlock_m};
  int found = 0;
  int tried = 0;
  for (const std::uint32_t block : coarse.free_blocks()) {
    if (block % 17 != 0) continue;
    const Point2 at = coarse.centre_of(block);
    const Pose2 truth{at.x() + 0.11, at.y() - 0.09, wrapped_angle(0.37 * block)};
    if (map.at(map.geometry().cell_at(truth.position())) != CellState::kFree) continue;
    const motion::BeamEnds ends = seen_from(truth, block);
    GlobalSearch search{{}, kHeadings};
    bool seen = false;
    for (int scan = 0; scan < 20 && search.under_way(); ++scan) {
      for (const Pose2& hypothesis : search.look(coarse, field, {ends, ends}, {}))
        seen = seen || very_near(hypothesis, truth);
    }
    found += seen ? 1 : 0;
    ++tried;
  }
  EXPECT_GT(tried, 30);
  EXPECT_GE(found, tried * 95 / 100);
}

TEST(GlobalSearch, CarriesWhatItFoundAlongWithTheWheels) {
  const OccupancyGrid map = test::drawn_flat();
  const sensor::LikelihoodField field{map, {}};
  const sensor::CoarseField coarse{map, field, kBlock_m};
  GlobalSearch search{{.candidates_a_scan = 8000, .places_a_scan = 50}, kHeadings};
  Pose2 truth{1.0, 2.0, 0.9};
  Pose2 joined{7.0, 8.0, -2.0};  // odometry starts anywhere
  bool found = false;
  int scans = 0;
  for (; scans < 40 && search.under_way(); ++scans) {
    const motion::BeamEnds seen = seen_from(truth, 1);
    for (const Pose2& hypothesis : search.look(coarse, field, {seen, seen}, joined)) {
      found = found || very_near(hypothesis, truth);
    }
    const Pose2 motion{0.03, 0.0, 0.02};
    truth = truth * motion;
    joined = joined * motion;
  }
  EXPECT_GT(scans, 10);
  EXPECT_TRUE(found);
}

TEST(GlobalSearch, RestsUntilTheRobotHasMovedOn) {
  const OccupancyGrid map = test::drawn_flat();
  const sensor::LikelihoodField field{map, {}};
  const sensor::CoarseField coarse{map, field, kBlock_m};
  const motion::BeamEnds ends = seen_from({4.5, 2.0, 1.1}, 3);
  GlobalSearch search{{}, kHeadings};
  while (search.under_way()) (void)search.look(coarse, field, {ends, ends}, {});
  for (int i = 0; i < 10; ++i) EXPECT_TRUE(search.look(coarse, field, {ends, ends}, {0.1, 0.0, 0.1}).empty());
  EXPECT_FALSE(search.under_way());
  (void)search.look(coarse, field, {ends, ends}, {0.6, 0.0, 0.1});
  EXPECT_TRUE(search.under_way());
}

}  // namespace
}  // namespace deltamap::localization::hypotheses
