// SPDX-License-Identifier: Apache-2.0
#include "localization/hypotheses/pose_aliases.hpp"

#include <gtest/gtest.h>

#include "core/angle.hpp"

namespace deltamap::localization::hypotheses {
namespace {

/// Two bays farther on, turned round.
Pose2 image_of(const Pose2& pose) { return Pose2{30.0, 12.0, radians(180.0)} * pose; }

TEST(PoseAliases, KnowNoneBeforeAHypothesisWasMet) {
  PoseAliases images{4};
  EXPECT_FALSE(images.next({1.0, 2.0, 0.3}));
}

TEST(PoseAliases, GoWithTheRobotWhereverItDrives) {
  PoseAliases images{4};
  images.note({3.0, 4.0, 0.2}, image_of({3.0, 4.0, 0.2}), 1.0);
  const Pose2 far_on{9.0, 1.0, -1.2};
  const std::optional<Pose2> there = images.next(far_on);
  ASSERT_TRUE(there);
  EXPECT_LT(distance_between(*there, image_of(far_on)), 1e-9);
  EXPECT_NEAR(turn_between(there->theta, image_of(far_on).theta), 0.0, 1e-9);
}

TEST(PoseAliases, AreOneWhereTheyAreMetAgainAnotherTime) {
  PoseAliases images{2};
  for (double x = 0.0; x < 5.0; x += 0.5) images.note({x, 1.0, 0.1}, image_of({x, 1.1, 0.1}), x);
  images.note({}, {0.0, 5.0, 0.0}, 0.0);
  EXPECT_GT(distance_between(*images.next({}), *images.next({})), 5.0) << "there is room for one more";
}

TEST(PoseAliases, AreLookedAtInTurn) {
  PoseAliases images{4};
  images.note({}, {5.0, 0.0, 0.0}, 1.0);
  images.note({}, {0.0, 5.0, 0.0}, 1.0);
  const Pose2 first = *images.next({});
  const Pose2 second = *images.next({});
  EXPECT_GT(distance_between(first, second), 5.0);
  EXPECT_LT(distance_between(*images.next({}), first), 1e-9);
}

TEST(PoseAliases, KeepThoseThatWereFollowedLongest) {
  PoseAliases images{2};
  images.note({}, {5.0, 0.0, 0.0}, 20.0);
  images.note({}, {0.0, 5.0, 0.0}, 2.0);
  images.note({}, {0.0, 9.0, 0.0}, 3.0);
  images.note({}, {9.0, 0.0, 0.0}, 1.0);
  const double x_m = images.next({})->x + images.next({})->x;
  EXPECT_DOUBLE_EQ(x_m, 5.0) << "the one of 20 m and the one of 3 m, neither that of 1 m";
}

TEST(PoseAliases, AreForgottenWhereTheyAreNotMetAgainOnALongWay) {
  PoseAliases images{4};
  images.note({}, {5.0, 0.0, 0.0}, 20.0);
  images.note({}, {0.0, 5.0, 0.0}, 2.0);
  images.age(600.0);
  images.note({}, {0.0, 5.0, 0.0}, 1.0);
  images.age(600.0);
  for (int i = 0; i < 2; ++i) EXPECT_DOUBLE_EQ(images.next({})->y, 5.0) << "the one that was met again";
}

TEST(PoseAliases, RememberNoneWhereThereIsNoRoom) {
  PoseAliases images{0};
  images.note({}, {5.0, 0.0, 0.0}, 20.0);
  EXPECT_FALSE(images.next({}));
}

}  // namespace
}  // namespace deltamap::localization::hypotheses
