// SPDX-License-Identifier: Apache-2.0
// What the oracle of `experiment verdict` calls ambiguous, in drawn worlds.
#include "experiments/verdict/ambiguity.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "simulation/scenario/start_map.hpp"

namespace deltamap::experiments {
namespace {

using simulation::Box;
using simulation::Circle;
using simulation::Object;
using simulation::ObjectKind;
using simulation::Polyline;
using simulation::RayCaster;
using simulation::World;

constexpr double kRange_m = 8.0;

World with(World world, const simulation::Shape& shape) {
  Object& added = world.objects.emplace_back();
  added.id = static_cast<int>(world.objects.size());
  added.kind = ObjectKind::kPost;
  added.shape = shape;
  return world;
}

/// 20 x 12 m with two racks, each the image of the other under half a turn about (10, 6).
World hall() {
  World world{{{1, ObjectKind::kWall, Polyline{{{0, 0}, {20, 0}, {20, 12}, {0, 12}, {0, 0}}}}}};
  world = with(world, Box{{6.0, 4.0}, 5.0, 1.6, 0.0});
  return with(world, Box{{14.0, 8.0}, 5.0, 1.6, 0.0});
}

World corridor() { return {{{1, ObjectKind::kWall, Polyline{{{0, 0}, {60, 0}, {60, 3}, {0, 3}, {0, 0}}}}}}; }

/// Views every 1.25 m of a straight way.
std::vector<Pose2> way(const Pose2& from, int views) {
  std::vector<Pose2> path;
  for (int i = 0; i < views; ++i) path.push_back(from * Pose2{1.25 * i, 0.0, 0.0});
  return path;
}

AmbiguityOracle oracle_of(const World& mapped, const Point2& start) {
  return {simulation::start_map(mapped, start, 0.05), {}};
}

Ambiguity in(const World& mapped, const World& present, const std::vector<Pose2>& path) {
  return oracle_of(mapped, path.front().position()).ambiguity(path, RayCaster{present}, kRange_m);
}

TEST(Ambiguity, IsSeenInAHallThatIsItsOwnImageUnderHalfATurn) {
  const std::vector<Pose2> path = way({2.0, 2.0, 0.0}, 12);
  const Ambiguity answer = in(hall(), hall(), path);
  EXPECT_TRUE(answer.ambiguous);
  EXPECT_LE(answer.unexplained, 1.0);
  const Pose2 middle = path[6];
  EXPECT_NEAR(answer.map_from_rival.x, 20.0 - middle.x, 0.1);
  EXPECT_NEAR(answer.map_from_rival.y, 12.0 - middle.y, 0.1);
  EXPECT_NEAR(std::abs(answer.map_from_rival.theta), std::numbers::pi, 0.05);
}

TEST(Ambiguity, EndsWithOnePostInView) {
  const World marked = with(hall(), Circle{{8.0, 1.0}, 0.25});
  const AmbiguityOracle oracle = oracle_of(marked, {2.0, 2.0});
  const std::vector<Pose2> path = way({2.0, 2.0, 0.0}, 12);
  const Ambiguity answer = oracle.ambiguity(path, RayCaster{marked}, kRange_m);
  EXPECT_FALSE(answer.ambiguous) << answer.log_odds;
  EXPECT_LE(answer.unexplained, 1.0);
  const std::size_t needed = oracle.views_needed(path, RayCaster{marked}, kRange_m, answer);
  EXPECT_GT(needed, 0u);
  EXPECT_LT(needed, path.size());
}

TEST(Ambiguity, NeedsOneViewOfAPlaceThatIsLikeNoOther) {
  const World room{{{1, ObjectKind::kWall, Polyline{{{0, 0}, {7, 0}, {7, 2}, {5, 5}, {2, 6}, {0, 4}, {0, 0}}}}}};
  const std::vector<Pose2> path = way({1.0, 2.0, 0.3}, 4);
  const AmbiguityOracle oracle = oracle_of(room, {1.0, 2.0});
  const Ambiguity whole = oracle.ambiguity(path, RayCaster{room}, kRange_m);
  EXPECT_FALSE(whole.ambiguous) << whole.log_odds;
  EXPECT_EQ(oracle.views_needed(path, RayCaster{room}, kRange_m, whole), 1u);
}

TEST(Ambiguity, RemainsWhereTheOnlyPostIsNotSeen) {
  const World marked = with(hall(), Circle{{18.5, 10.5}, 0.25});
  EXPECT_TRUE(in(marked, marked, way({2.0, 2.0, 0.0}, 2)).ambiguous);
}

TEST(Ambiguity, LiesAlongACorridorWhoseEndsAreOutOfReach) {
  const Ambiguity answer = in(corridor(), corridor(), way({20.0, 1.2, 0.1}, 6));
  EXPECT_TRUE(answer.ambiguous);
  EXPECT_GT(std::abs(answer.map_from_rival.x - (20.0 + 1.25 * 3.0)), 0.5);
}

TEST(Ambiguity, IsNotMadeByAFewObstaclesThatTheMapDoesNotHave) {
  const World marked = with(with(hall(), Circle{{8.0, 1.0}, 0.25}), Box{{19.0, 6.0}, 1.0, 3.0, 0.0});
  const World changed = with(marked, Circle{{11.0, 3.4}, 0.2});
  const Ambiguity answer = in(marked, changed, way({2.0, 2.0, 0.0}, 12));
  EXPECT_GT(answer.unexplained, 0.5);
  EXPECT_FALSE(answer.ambiguous) << answer.log_odds;
}

TEST(Ambiguity, IsTotalWhereNothingIsSeen) {
  const World far{{{1, ObjectKind::kWall, Polyline{{{0, 0}, {60, 0}, {60, 60}, {0, 60}, {0, 0}}}}}};
  const Ambiguity answer = in(far, far, way({30.0, 30.0, 0.0}, 3));
  EXPECT_TRUE(answer.ambiguous);
  EXPECT_EQ(answer.pieces, 0.0);
}

TEST(MapDistances, AreThoseBetweenTheMiddlesOfCells) {
  OccupancyGrid map{{200, 100, 0.05, {-1.0, -1.0}}, CellState::kFree};
  map.set({40, 50}, CellState::kOccupied);
  const MapDistances distances{map};
  const auto at = [&](int column, int row) {
    const Point2 p = map.geometry().centre_of({column, row});
    return distances.to_obstacle_m(static_cast<float>(p.x()), static_cast<float>(p.y()));
  };
  EXPECT_FLOAT_EQ(at(40, 50), 0.0F);
  EXPECT_NEAR(at(43, 54), 0.25F, 0.007);
  EXPECT_NEAR(at(10, 50), 1.5F, 0.007);
  EXPECT_FLOAT_EQ(at(150, 50), MapDistances::kMost_m);
  EXPECT_FLOAT_EQ(distances.to_obstacle_m(-5.0F, 0.0F), MapDistances::kMost_m);
  EXPECT_NEAR(distances.to_floor_m(1.025F, 1.525F), 0.05F, 0.007) << "beside the obstacle is floor";
}

}  // namespace
}  // namespace deltamap::experiments
