// SPDX-License-Identifier: Apache-2.0
#include "mapping/scan_set/keyframe_choice.hpp"

#include <gtest/gtest.h>

namespace deltamap::mapping::scan_set {
namespace {

constexpr KeyframeParams kParams{.moved_m = 0.15, .turned_rad = 0.17, .waited_s = 0.5};

ScanPlace scan_at(const Pose2& odom_from_robot, double time_s = 0.0, std::uint32_t epoch = 0) {
  return {odom_from_robot, epoch, timestamp_from_ns(0) + duration_from_seconds(time_s)};
}

bool follows(const ScanPlace& now) { return is_next_keyframe(kParams, scan_at({1.0, 2.0, 3.1}), now); }

TEST(KeyframeChoice, WantsWayTurnOrTime) {
  EXPECT_FALSE(follows(scan_at({1.1, 2.0, 3.0}, 0.4)));
  EXPECT_TRUE(follows(scan_at({1.0, 1.84, 3.1})));
  EXPECT_TRUE(follows(scan_at({1.0, 2.0, 3.1}, 0.5)));
}

TEST(KeyframeChoice, TakesATurnEitherWayAndAcrossHalfATurn) {
  EXPECT_TRUE(follows(scan_at({1.0, 2.0, 2.92})));
  EXPECT_TRUE(follows(scan_at({1.0, 2.0, -3.01})));
  EXPECT_FALSE(follows(scan_at({1.0, 2.0, -3.1})));
}

TEST(KeyframeChoice, AnOdometryThatBeginsAnewStartsAKeyframe) {
  EXPECT_TRUE(follows(scan_at({1.0, 2.0, 3.1}, 0.0, 1)));
}

}  // namespace
}  // namespace deltamap::mapping::scan_set
