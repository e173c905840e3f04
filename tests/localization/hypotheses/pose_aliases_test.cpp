// SPDX-License-Identifier: Apache-2.0
#include "localization/hypotheses/pose_aliases.hpp"

#include <gtest/gtest.h>

#include "core/angle.hpp"

namespace deltamap::localization::hypotheses {
namespace {

/// Two bays farther on, turned round.
Pose2 image_of(const Pose2& pose) { return Pose2{30.0, 12.0, radians(180.0)} * pose; }

TEST(PoseAliases, KnowNoneBeforeAHypothesisWasMet) {
  PoseAliases aliases{4};
  EXPECT_FALSE(aliases.next({1.0, 2.0, 0.3}));
}

TEST(PoseAliases, GoWithTheRobotWhereverItDrives) {
  PoseAliases aliases{4};
  aliases.note({3.0, 4.0, 0.2}, image_of({3.0, 4.0, 0.2}), 1.0);
  const Pose2 far_on{9.0, 1.0, -1.2};
  const std::optional<Pose2> there = aliases.next(far_on);
  ASSERT_TRUE(there);
  EXPECT_LT(distance_between(*there, image_of(far_on)), 1e-9);
  EXPECT_NEAR(turn_between(there->theta, image_of(far_on).theta), 0.0, 1e-9);
}

TEST(PoseAliases, AreOneWhereTheyAreMetAgainAnotherTime) {
  PoseAliases aliases{2};
  for (double x = 0.0; x < 5.0; x += 0.5) aliases.note({x, 1.0, 0.1}, image_of({x, 1.1, 0.1}), x);
  aliases.note({}, {0.0, 5.0, 0.0}, 0.0);
  EXPECT_GT(distance_between(*aliases.next({}), *aliases.next({})), 5.0) << "there is room for one more";
}

TEST(PoseAliases, AreLookedAtInTurn) {
  PoseAliases aliases{4};
  aliases.note({}, {5.0, 0.0, 0.0}, 1.0);
  aliases.note({}, {0.0, 5.0, 0.0}, 1.0);
  const Pose2 first = *aliases.next({});
  const Pose2 second = *aliases.next({});
  EXPECT_GT(distance_between(first, second), 5.0);
  EXPECT_LT(distance_between(*aliases.next({}), first), 1e-9);
}

TEST(PoseAliases, KeepThoseThatWereFollowedLongest) {
  PoseAliases aliases{2};
  aliases.note({}, {5.0, 0.0, 0.0}, 20.0);
  aliases.note({}, {0.0, 5.0, 0.0}, 2.0);
  aliases.note({}, {0.0, 9.0, 0.0}, 3.0);
  aliases.note({}, {9.0, 0.0, 0.0}, 1.0);
  const double x_m = aliases.next({})->x + aliases.next({})->x;
  EXPECT_DOUBLE_EQ(x_m, 5.0) << "the one of 20 m and the one of 3 m, neither that of 1 m";
}

TEST(PoseAliases, AreForgottenWhereTheyAreNotMetAgainOnALongWay) {
  PoseAliases aliases{4};
  aliases.note({}, {5.0, 0.0, 0.0}, 20.0);
  aliases.note({}, {0.0, 5.0, 0.0}, 2.0);
  aliases.age(600.0);
  aliases.note({}, {0.0, 5.0, 0.0}, 1.0);
  aliases.age(600.0);
  for (int i = 0; i < 2; ++i) EXPECT_DOUBLE_EQ(aliases.next({})->y, 5.0) << "the one that was met again";
}

TEST(PoseAliases, RememberNoneWhereThereIsNoRoom) {
  PoseAliases aliases{0};
  aliases.note({}, {5.0, 0.0, 0.0}, 20.0);
  EXPECT_FALSE(aliases.next({}));
}

}  // namespace
}  // namespace deltamap::localization::hypotheses
