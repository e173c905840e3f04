// SPDX-License-Identifier: Apache-2.0
#include "localization/hypotheses/global_search.hpp"

#include <gtest/gtest.h>

#include "tests/support/scans/cast_ends.hpp"
#include "tests/support/worlds/drawn_flat.hpp"

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
  GlobalSearch search{{.alone = {.candidates = 8000, .refined = 50}}, kHeadings};
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
