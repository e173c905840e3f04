// SPDX-License-Identifier: Apache-2.0
#include "simulation/movers/person.hpp"

#include <gtest/gtest.h>

namespace deltamap::simulation {
namespace {

constexpr double kPersonStep_s = 0.005;
const Circle kFarRobot{{100, 100}, 0.25};

World walled_hall() { return {{{1, ObjectKind::kWall, Polyline{{{0, 0}, {20, 0}, {20, 20}, {0, 20}, {0, 0}}}}}}; }

TEST(Person, WalksStopsAndWalksOnAlongThePath) {
  Person person{{.path = {{2, 2}, {18, 2}}}, Random{1}};
  const RayCaster world{walled_hall()};
  int starts = 0;
  int stops = 0;
  bool walking = true;
  double farthest = 0.0;
  for (int i = 0; i < 60'000; ++i) {  // 300 s
    const Point2 before = person.body().centre;
    person.move(kPersonStep_s, world, kFarRobot);
    const bool moved = (person.body().centre - before).norm() > 1e-9;
    if (moved && !walking) ++starts;
    if (!moved && walking) ++stops;
    walking = moved;
    farthest = std::max(farthest, person.body().centre.x());
    ASSERT_NEAR(person.body().centre.y(), 2.0, 1e-9);
  }
  EXPECT_GT(stops, 5);
  EXPECT_GT(starts, 5);
  EXPECT_GT(farthest, 17.5);
}

TEST(Person, WaitsForTheRobotAndTurnsBackAtABlockedWay) {
  Person person{{.path = {{2, 10}, {18, 10}}, .walk_least_s = 1e5, .walk_most_s = 1e5}, Random{1}};
  const RayCaster world{walled_hall()};
  const Circle robot{{8, 10}, 0.25};
  double farthest = 0.0;
  for (int i = 0; i < 2400; ++i) {  // 12 s: 5 to get there, 4 of patience, then back
    person.move(kPersonStep_s, world, robot);
    farthest = std::max(farthest, person.body().centre.x());
  }
  EXPECT_LT(farthest, 8.0 - 0.25 - 0.2 - 0.49);
  EXPECT_GT(farthest, 6.5);
  EXPECT_LT(person.body().centre.x(), farthest - 1.0);
}

TEST(Person, DoesNotWalkIntoAContainerThatStandsInTheWay) {
  Person person{{.path = {{2, 10}, {18, 10}}, .walk_least_s = 1e5, .walk_most_s = 1e5}, Random{1}};
  const RayCaster world{walled_hall().with({2, ObjectKind::kContainer, Box{{10, 10}, 2, 2, 0}})};
  for (int i = 0; i < 20'000; ++i) {
    person.move(kPersonStep_s, world, kFarRobot);
    ASSERT_LT(person.body().centre.x(), 9.0 - 0.2);
  }
}

/// Four corners, the first before a recess that boxes shut towards the second and the last.
const std::vector<Point2> kPastARecess{{10, 10}, {18, 10}, {10, 18}, {2, 10}};
const World kRecess = walled_hall()
                          .with({2, ObjectKind::kContainer, Box{{12, 10}, 1, 4, 0}})
                          .with({3, ObjectKind::kContainer, Box{{8, 10}, 1, 4, 0}});

TEST(Person, GoesToAnotherCornerWhereThePathIsShutBothWays) {
  Person person{{.path = kPastARecess, .closed = true, .walk_least_s = 1e5, .walk_most_s = 1e5}, Random{1}};
  const RayCaster world{kRecess};
  double farthest = 0.0;
  for (int i = 0; i < 40'000; ++i) {  // 200 s
    person.move(kPersonStep_s, world, kFarRobot);
    farthest = std::max(farthest, person.body().centre.y());
  }
  EXPECT_GT(farthest, 17.5);
}

TEST(Person, TurnsBackWhereTheWayBetweenTwoBlocksIsLong) {
  const std::vector<Point2> path{{5, 5}, {18, 5}, {18, 18}, {5, 18}};
  Person person{{.path = path, .closed = true, .walk_least_s = 1e5, .walk_most_s = 1e5}, Random{1}};
  const RayCaster world{walled_hall()
                            .with({2, ObjectKind::kContainer, Box{{15, 5}, 1, 4, 0}})
                            .with({3, ObjectKind::kContainer, Box{{5, 15}, 4, 1, 0}})};
  for (int i = 0; i < 60'000; ++i) {  // 300 s between two boxes, by the corner in between
    person.move(kPersonStep_s, world, kFarRobot);
    const Point2 at = person.body().centre;
    ASSERT_LT(std::min(at.x(), at.y()), 5.0 + 1e-3);
  }
}

}  // namespace
}  // namespace deltamap::simulation
