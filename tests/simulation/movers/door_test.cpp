// SPDX-License-Identifier: Apache-2.0
#include "simulation/movers/door.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "simulation/scenario/start_map.hpp"
#include "simulation/world/bodies.hpp"
#include "simulation/world/ray_caster.hpp"

namespace deltamap::simulation {
namespace {

constexpr double kDoorStep_s = 0.05;
constexpr double kSameLeaf_m = 1e-9;

DoorParams sliding() { return {.closed = {{5, 2}, {5, 4}}}; }

DoorParams swinging() {
  DoorParams door = sliding();
  door.swing_rad = radians(90);
  return door;
}

TEST(Door, SwingsAboutItsHingeOrSlidesIntoTheWall) {
  const auto half_slid = leaf_of(sliding(), 0.5);
  ASSERT_TRUE(half_slid);
  EXPECT_NEAR((half_slid->to - Point2(5, 3)).norm(), 0.0, kSameLeaf_m);
  EXPECT_FALSE(leaf_of(sliding(), 1.0));
  const auto swung = leaf_of(swinging(), 1.0);
  ASSERT_TRUE(swung);
  EXPECT_NEAR((swung->to - Point2(3, 2)).norm(), 0.0, kSameLeaf_m);
  EXPECT_NEAR((leaf_of(swinging(), 0.0)->to - Point2(5, 4)).norm(), 0.0, kSameLeaf_m);
}

TEST(Door, StandsOpenForItsShareOfTheTimeAndMovesAtEachPeriod) {
  for (const double share : {0.2, 0.5, 0.8}) {
    DoorParams params = sliding();
    params.open_share = share;
    params.period_s = 50.0;
    Door door{params, Random{4}};
    double open_s = 0.0;
    int openings = 0;
    constexpr double kLasts_s = 50'000.0;
    for (double t = 0.0; t < kLasts_s; t += kDoorStep_s) {
      const bool was_shut = door.is_shut();
      door.move(kDoorStep_s, {});
      openings += was_shut && !door.is_shut() ? 1 : 0;
      open_s += door.is_shut() ? 0.0 : kDoorStep_s;
    }
    EXPECT_NEAR(open_s / kLasts_s, share, 0.06) << "its moving counts as open";
    EXPECT_NEAR(openings, 1000, 50);
  }
}

TEST(Door, StaysAsItIsWhereItsShareIsNoneOrAll) {
  for (const double share : {0.0, 1.0}) {
    DoorParams params = swinging();
    params.open_share = share;
    Door door{params, Random{1}};
    for (int i = 0; i < 20'000; ++i) {
      door.move(kDoorStep_s, {});
      ASSERT_EQ(door.is_shut(), share == 0.0);
    }
  }
}

TEST(Door, WaitsForWhoeverStandsInItsWay) {
  for (const DoorParams& params : {sliding(), swinging()}) {
    Door door{params, Random{1}};
    const Circle robot{{5, 3}, 0.25};
    while (door.is_shut() || (door.leaf() && distance_between(robot.centre, *door.leaf()) < 1.0))
      door.move(kDoorStep_s, {});
    for (int i = 0; i < 20'000; ++i) {
      door.move(kDoorStep_s, {&robot, 1});
      ASSERT_FALSE(door.is_shut());
      ASSERT_TRUE(!door.leaf() || distance_between(robot.centre, *door.leaf()) > robot.radius_m + 0.14);
    }
  }
}

TEST(Door, IsMetByBeamsAndCoveredByBeadsToBumpInto) {
  Bodies bodies;
  bodies.add_leaf(sliding().closed);
  const RayCaster world{World{{{1, ObjectKind::kWall, Polyline{{{0, 0}, {10, 0}, {10, 6}, {0, 6}, {0, 0}}}}}}};
  EXPECT_NEAR(world.cast({1, 3}, 0.0, 80.0, bodies.surfaces())->range_m, 4.0, kSameLeaf_m);
  EXPECT_NEAR(world.cast({1, 5}, 0.0, 80.0, bodies.surfaces())->range_m, 9.0, kSameLeaf_m) << "beside it";
  EXPECT_TRUE(bodies.walkers().empty());
  EXPECT_EQ(bodies.leaves().size(), 1u);
  EXPECT_GT(bodies.obstacles().size(), 15u);
}

TEST(Door, IsDrawnShutOrOpenInTheFirstMapWithTheFloorOnBothSides) {
  const std::string room =
      "walls:\n  - [[0, 0], [10, 0], [10, 6], [0, 6], [0, 0]]\n  - [[5, 0], [5, 2]]\n  - [[5, 4], [5, 6]]\n"
      "robot:\n  start: [2, 3, 0]\ndoors:\n  - {leaf: [5, 2, 5, 4], drawn: ";
  for (const std::string drawn : {"closed", "open"}) {
    const OccupancyGrid map = start_map(parse_scenario(room + drawn + "}\n", "room.yaml"), 0.05);
    const auto state = [&](double x, double y) { return map.at(map.geometry().cell_at({x, y})); };
    EXPECT_EQ(state(5, 3), drawn == "closed" ? CellState::kOccupied : CellState::kFree);
    EXPECT_EQ(state(8, 3), CellState::kFree);
  }
}

}  // namespace
}  // namespace deltamap::simulation
