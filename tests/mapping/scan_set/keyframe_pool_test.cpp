// SPDX-License-Identifier: Apache-2.0
#include "mapping/scan_set/keyframe_pool.hpp"

#include <gtest/gtest.h>

#include <memory>

namespace deltamap::mapping::scan_set {
namespace {

Timestamp seconds_on(double time_s) { return timestamp_from_ns(0) + duration_from_seconds(time_s); }

TrackedScan scan_from(double time_s, const Pose2& odom_from_robot, std::uint32_t epoch = 0) {
  TrackedScan tracked;
  tracked.scan.number = static_cast<std::uint32_t>(time_s);
  tracked.scan.time = seconds_on(time_s);
  tracked.odom_from_robot = odom_from_robot;
  tracked.odometry_epoch = epoch;
  tracked.estimate.map = std::make_shared<const OccupancyGrid>();
  return tracked;
}

/// One scan a second; every other one has voted on block 7, all on block 3.
KeyframePool pool_of(std::uint32_t scans, const KeyframeParams& params = {}) {
  KeyframePool pool{params};
  for (std::uint32_t i = 0; i < scans; ++i) {
    pool.keep(scan_from(i, {0.2 * i, 0.0, 0.0}),
              i % 2 == 0 ? std::vector<std::uint32_t>{3, 7} : std::vector<std::uint32_t>{3});
  }
  return pool;
}

std::vector<std::uint32_t> numbers(const KeptScans& scans) {
  std::vector<std::uint32_t> numbers;
  for (const auto& scan : scans) numbers.push_back(scan->scan.number);
  return numbers;
}

TEST(KeyframePool, IsDueAtFirstThenByWayTurnOrTime) {
  KeyframePool pool{{.moved_m = 0.15, .turned_rad = 0.17, .waited_s = 0.5}};
  EXPECT_TRUE(pool.is_due(scan_from(1.0, {})));
  pool.keep(scan_from(1.0, {}), {3});
  EXPECT_FALSE(pool.is_due(scan_from(1.4, {0.1, 0.1, 0.16})));
  EXPECT_TRUE(pool.is_due(scan_from(1.4, {0.16, 0.0, 0.0})));
  EXPECT_TRUE(pool.is_due(scan_from(1.4, {0.0, 0.0, -0.18})));
  EXPECT_TRUE(pool.is_due(scan_from(1.51, {})));
  EXPECT_TRUE(pool.is_due(scan_from(1.1, {}, 1))) << "nothing joins two epochs";
}

TEST(KeyframePool, AnswersThoseThatVotedOnOneOfTheBlocksInOrderOfTime) {
  const KeyframePool pool = pool_of(6);
  EXPECT_EQ(numbers(pool.that_saw({7}, seconds_on(0.0))), (std::vector<std::uint32_t>{0, 2, 4}));
  EXPECT_EQ(numbers(pool.that_saw({99, 7, 3}, seconds_on(0.0))), (std::vector<std::uint32_t>{0, 1, 2, 3, 4, 5}));
  EXPECT_TRUE(pool.that_saw({5}, seconds_on(0.0)).empty());
  EXPECT_TRUE(pool.that_saw({}, seconds_on(0.0)).empty());
}

TEST(KeyframePool, AnswersNoneFromBeforeThatTime) {
  EXPECT_EQ(numbers(pool_of(6).that_saw({7}, seconds_on(2.0))), (std::vector<std::uint32_t>{2, 4}));
}

TEST(KeyframePool, AnswersTheNewestWhereTheyAreTooMany) {
  EXPECT_EQ(numbers(pool_of(6, {.most_in_set = 2}).that_saw({3}, seconds_on(0.0))), (std::vector<std::uint32_t>{4, 5}));
}

TEST(KeyframePool, ForgetsTheOldest) {
  EXPECT_EQ(numbers(pool_of(6, {.most_kept = 3}).that_saw({3}, seconds_on(0.0))),
            (std::vector<std::uint32_t>{3, 4, 5}));
}

TEST(KeyframePool, ForgetsThoseOfAnotherOdometryEpoch) {
  KeyframePool pool = pool_of(6);
  pool.keep(scan_from(6.0, {}, 1), {3});
  EXPECT_EQ(numbers(pool.that_saw({3}, seconds_on(0.0))), (std::vector<std::uint32_t>{6}));
}

TEST(KeyframePool, HoldsNoMapOfTheScans) {
  for (const auto& scan : pool_of(3).that_saw({3}, seconds_on(0.0))) EXPECT_EQ(scan->estimate.map, nullptr);
}

}  // namespace
}  // namespace deltamap::mapping::scan_set
