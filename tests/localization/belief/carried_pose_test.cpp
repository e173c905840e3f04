// SPDX-License-Identifier: Apache-2.0
#include "localization/belief/carried_pose.hpp"

#include <gtest/gtest.h>

namespace deltamap::localization::belief {
namespace {

constexpr CarriedPose::Step kFollowed{.is_continued = true, .fits_before = true, .driven_m = 0.1};

CarriedPose after(const CarriedPose::Step& step, int steps) {
  CarriedPose pose;
  pose.start_from_here();
  for (int i = 0; i < steps; ++i) pose.observe(step);
  return pose;
}

TEST(CarriedPose, IsNoneThatWasNeverSurelyRight) {
  CarriedPose pose;
  pose.observe(kFollowed);
  EXPECT_FALSE(pose.is_carried());
}

TEST(CarriedPose, IsCarriedForTwentyMetresAndForAsLongAsItStands) {
  EXPECT_TRUE(after(kFollowed, 190).is_carried());
  EXPECT_FALSE(after(kFollowed, 210).is_carried());
  CarriedPose::Step standing = kFollowed;
  standing.driven_m = 0.0;
  EXPECT_TRUE(after(standing, 100'000).is_carried());
}

TEST(CarriedPose, EndsWhereAScanFitsNowhereOrWheelsBeginAnew) {
  for (const bool fits_before : {true, false}) {
    CarriedPose pose = after(kFollowed, 3);
    pose.observe({.is_continued = !fits_before, .fits_before = fits_before, .driven_m = 0.1});
    pose.observe(kFollowed);
    EXPECT_FALSE(pose.is_carried()) << fits_before;
    pose.start_from_here();
    EXPECT_TRUE(pose.is_carried());
  }
}

}  // namespace
}  // namespace deltamap::localization::belief
