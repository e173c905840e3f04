// SPDX-License-Identifier: Apache-2.0
// How the drives are scored: what counts as followed and how soon, and the override rule that ghosts are held against.
#include "experiments/watch/change_following.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "experiments/watch/override_map.hpp"
#include "simulation/scenario/scenario.hpp"
#include "simulation/scenario/start_map.hpp"
#include "tests/support/scans/cast_scan.hpp"
#include "tests/support/scans/drawn_scan.hpp"
#include "tests/support/worlds/block_room.hpp"

namespace deltamap::experiments {
namespace {

namespace score = simulation::score;

/// A room from which a block has gone, looked at for some time.
class Room {
 public:
  Room() {
    const simulation::Change gone{
        simulation::ChangeKind::kRemoved, scenario.world.largest_id(), {{3.5, 1.5}, 1.0, 1.0, 0.0}, {}};
    changes.apply(gone, Timestamp{}, {1.0, 1.0});
    after = simulation::surveyed_map(changes.world(), {1.0, 1.0}, first.geometry());
    surfaces = score::drawn_surfaces(changes.world(), first.geometry());
  }
  /// For so long, judged each second, with the map that is given.
  void look(double for_s, const OccupancyGrid& map, const OccupancyGrid* layered = nullptr) {
    for (const double end_s = now_s + for_s; now_s < end_s; now_s += 1.0) {
      changes.look(changes.view_from({1.0, 1.5, 0.0}, 20.0, 181, {}), 1.0, 3);
      by_map.judge(changes, map, surfaces, now_s);
      if (layered != nullptr) by_layer.judge(changes, *layered, surfaces, now_s, &by_map);
    }
  }

  simulation::Scenario scenario = test::block_room();
  OccupancyGrid first = simulation::start_map(scenario, 0.05);
  score::ChangeWatch changes{scenario, first.geometry()};
  OccupancyGrid after;
  OccupancyGrid surfaces;
  ChangeFollowing by_map;
  ChangeFollowing by_layer;
  double now_s = 0.0;
};

TEST(ChangeFollowing, CountsWhatIsFollowedSoonWithWhatIsInViewForLong) {
  Room room;
  room.look(2.0, room.first);
  room.look(18.0, room.after);
  const auto numbers = room.by_map.numbers(room.changes);
  EXPECT_EQ(numbers.seen, 1u);
  EXPECT_EQ(numbers.recall, 1.0);
  EXPECT_EQ(numbers.median_s, 3.0);
  EXPECT_EQ(numbers.within_10s, 1.0);
  EXPECT_EQ(room.by_map.numbers(room.changes, ChangeFollowing::Which::kAppeared).seen, 0u);
}

TEST(ChangeFollowing, AsksNothingOfWhatWasInViewTooShortlyOrWasRightBefore) {
  Room glanced_at;
  glanced_at.look(2.0, glanced_at.first);
  glanced_at.look(5.0, glanced_at.after);
  EXPECT_EQ(glanced_at.by_map.numbers(glanced_at.changes).seen, 0u);
  Room right_before;
  right_before.look(20.0, right_before.after);
  EXPECT_EQ(right_before.by_map.numbers(right_before.changes).seen, 0u);
}

TEST(ChangeFollowing, WhatIsNeverFoundTakesForEver) {
  Room room;
  room.look(20.0, room.first);
  EXPECT_EQ(room.by_map.numbers(room.changes).recall, 0.0);
  EXPECT_TRUE(std::isinf(room.by_map.numbers(room.changes).median_s));
}

TEST(ChangeFollowing, ALayerThatIsRightAtTheFirstLookHasFollowedWhereTheMapHadNot) {
  Room room;
  room.look(20.0, room.first, &room.after);
  EXPECT_EQ(room.by_layer.numbers(room.changes).recall, 1.0);
  EXPECT_EQ(room.by_layer.numbers(room.changes).median_s, 1.0);
}

TEST(OverrideMap, WritesWhoeverStandsThereAtOnceAndForgetsHimAtOnce) {
  const OccupancyGrid empty{{80, 80, 0.05, {0.0, 0.0}}, CellState::kFree};
  OccupancyGrid walled = empty;
  test::fill_box(walled, {3.5, 0.0}, {3.7, 4.0}, CellState::kOccupied);
  OccupancyGrid somebody = walled;
  test::fill_box(somebody, {2.0, 1.8}, {2.3, 2.2}, CellState::kOccupied);
  OverrideMap override_map{empty};
  Random random{1};
  const Pose2 pose{0.5, 2.0, 0.0};
  const Cell his_face = empty.geometry().cell_at({2.02, 2.0});
  const test::DrawnScanParams exact{.range_deviation_m = 0.0};
  const auto scan = [&](const OccupancyGrid& world, double time_s) {
    return test::drawn_scan(world, nullptr, pose, time_s, random, exact);
  };
  override_map.observe(scan(somebody, 0.0));
  EXPECT_EQ(override_map.map()[his_face], CellState::kOccupied);
  override_map.observe(scan(walled, 0.2));  // no keyframe: neither moved nor waited
  EXPECT_EQ(override_map.map()[his_face], CellState::kOccupied);
  override_map.observe(scan(walled, 0.6));
  EXPECT_EQ(override_map.map()[his_face], CellState::kFree);
}

}  // namespace
}  // namespace deltamap::experiments
