// SPDX-License-Identifier: Apache-2.0
#include "simulation/score/change_watch.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>

namespace deltamap::simulation::score {
namespace {

/// A room with one container, before which the robot stands.
class ChangeWatchRoom : public testing::Test {
 protected:
  ChangeWatchRoom()
      : scenario{parse_scenario("walls:\n  - [[0, 0], [12, 0], [12, 10], [0, 10], [0, 0]]\n"
                                "containers:\n  - [6, 5, 2, 2, 0]\nrobot:\n  start: [6, 1, 90]\n",
                                "room.yaml")},
        watch{scenario, GridGeometry{240, 200, 0.05, {0.0, 0.0}}} {}

  void look(const Pose2& pose) { watch.look(watch.view_from(pose, 32.0, 181, {}), 0.2, 3); }
  void remove(int id, double time_s) {
    watch.apply({ChangeKind::kRemoved, id, kPlace, std::nullopt}, after(time_s), kRobot);
  }
  void add(int id, double time_s) {
    watch.apply({ChangeKind::kAdded, id, kPlace, std::nullopt}, after(time_s), kRobot);
  }

  static Timestamp after(double time_s) { return timestamp_from_ns(1'000'000'000'000) + duration_from_seconds(time_s); }

  static constexpr Pose2 kFacing{6.0, 1.0, 1.57};  // the container
  static constexpr Pose2 kAway{6.0, 1.0, -1.57};   // and the wall
  static inline const Box kPlace{{6.0, 5.0}, 2.0, 2.0, 0.0};
  static inline const Point2 kRobot{6.0, 1.0};
  Scenario scenario;
  ChangeWatch watch;
  int first = scenario.world.objects.back().id;
};

TEST_F(ChangeWatchRoom, WhatIsPutWhereNobodySawTheOtherGoIsNotToldApart) {
  remove(first, 1.0);
  look(kAway);
  add(50, 2.0);
  EXPECT_TRUE(watch.watched()[0].is_told_apart);
  EXPECT_FALSE(watch.watched()[1].is_told_apart) << "a container stands there as before";
}

TEST_F(ChangeWatchRoom, OneLookAtTheEmptyPlaceIsEnough) {
  remove(first, 1.0);
  look(kFacing);
  add(50, 2.0);
  EXPECT_TRUE(watch.watched()[1].is_told_apart);
}

TEST_F(ChangeWatchRoom, ALookAfterTheNeighbourHasChangedCounts) {
  remove(first, 1.0);
  const Box beside{{8.0, 5.0}, 2.0, 2.0, 0.0};
  watch.apply({ChangeKind::kAdded, 51, beside, std::nullopt}, after(1.5), kRobot);
  EXPECT_TRUE(watch.watched()[0].change.is_overtaken);
  look(kFacing);
  EXPECT_EQ(watch.watched()[0].witness.longest_seen_s(), 0.0) << "not among what was seen of it";
  add(50, 2.0);
  EXPECT_TRUE(watch.watched()[2].is_told_apart);
}

TEST_F(ChangeWatchRoom, WhatCameAndWentUnseenIsNotToldApart) {
  remove(first, 1.0);
  look(kFacing);
  add(50, 2.0);
  remove(50, 3.0);
  EXPECT_FALSE(watch.watched()[2].is_told_apart) << "the place is as empty as it was";
}

TEST_F(ChangeWatchRoom, ASeenFaceIsNotAllAround) {
  remove(first, 1.0);
  for (int i = 0; i < 20; ++i) look(kFacing);
  EXPECT_GE(watch.watched()[0].witness.longest_seen_s(), 3.0);
  EXPECT_EQ(watch.watched()[0].faces_that_show, (std::array{true, true, true, true}));
  EXPECT_TRUE(watch.watched()[0].is_seen_all_around(3.0)) << "where it has gone one looks through all of it";
  add(50, 10.0);
  for (int i = 0; i < 20; ++i) look(kFacing);
  EXPECT_GE(watch.watched()[1].witness.longest_seen_s(), 3.0);
  EXPECT_FALSE(watch.watched()[1].is_seen_all_around(3.0)) << "its back was not seen";
  for (const Pose2& pose : {Pose2{10.0, 5.0, 3.14}, Pose2{2.0, 5.0, 0.0}, Pose2{6.0, 9.0, -1.57}}) {
    for (int i = 0; i < 20; ++i) look(pose);
  }
  EXPECT_TRUE(watch.watched()[1].is_seen_all_around(3.0));
}

TEST_F(ChangeWatchRoom, AFaceThatNobodyCouldSeeIsNotAskedFor) {
  const Box at_wall{{6.0, 9.0}, 2.0, 2.0, 0.0};
  watch.apply({ChangeKind::kAdded, 52, at_wall, std::nullopt}, after(1.0), kRobot);
  const auto& shows = watch.watched()[0].faces_that_show;
  EXPECT_EQ(std::count(shows.begin(), shows.end(), true), 3) << "its back stands against the wall";
}

}  // namespace
}  // namespace deltamap::simulation::score
