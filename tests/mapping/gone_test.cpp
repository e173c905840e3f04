// SPDX-License-Identifier: Apache-2.0
// What beams show to be gone together that none of them shows alone: specks between them, and the face that they pass.
#include <gtest/gtest.h>

#include "mapping/awareness/beam_votes.hpp"
#include "mapping/awareness/specks.hpp"
#include "tests/support/drawn_hall.hpp"
#include "tests/support/seen_scan.hpp"

namespace deltamap::mapping::awareness {
namespace {

const Pose2 kRobot{2.0, 5.0, 0.0};

OccupancyGrid room() {
  OccupancyGrid room{{200, 200, 0.05, {0.0, 0.0}}, CellState::kFree};
  test::fill(room, {9.8, 0.0}, {9.9, 10.0}, CellState::kOccupied);
  return room;
}

OccupancyGrid room_with(Point2 low, Point2 high) {
  OccupancyGrid with = room();
  test::fill(with, low, high, CellState::kOccupied);
  return with;
}

class Gone : public testing::Test {
 protected:
  /// What the robot sees of `world`.
  void look(const OccupancyGrid& world, const OccupancyGrid& map, const Pose2& robot = kRobot) {
    tracked = test::seen_scan(world, robot, 0.0, random);
    clear = ClearSpace{map, 2};
    beams = beam_evidence(map, clear, tracked, {});
  }
  std::size_t missed() { return specks.missed(tracked, beams, {}).size(); }

  Random random{1};
  Specks specks{SpeckParams{}};
  ClearSpace clear;
  TrackedScan tracked;
  std::vector<BeamVerdict> beams;
  const OccupancyGrid speck = room_with({4.0, 5.0}, {4.1, 5.1});  // four cells, 2 m ahead
};

TEST_F(Gone, IsASpeckThatBeamsWouldHaveMet) {
  specks.take_map(room());
  specks.take_map(speck);
  look(room(), speck);
  EXPECT_EQ(missed(), 4U);
}

TEST_F(Gone, IsNoSpeckThatBeamsMeet) {
  specks.take_map(room());
  specks.take_map(speck);
  look(speck, speck);
  EXPECT_EQ(missed(), 0U);
}

TEST_F(Gone, IsNoSpeckBesideWhichABeamEnds) {
  specks.take_map(room());
  specks.take_map(speck);
  look(room_with({4.0, 5.15}, {4.1, 5.25}), speck);  // the pose may be so far off
  EXPECT_EQ(missed(), 0U);
}

TEST_F(Gone, IsNoSpeckThatFitsBetweenTwoBeams) {
  specks.take_map(room());
  specks.take_map(room_with({8.5, 5.0}, {8.55, 5.05}));
  look(room(), room_with({8.5, 5.0}, {8.55, 5.05}));
  EXPECT_EQ(missed(), 0U);
}

TEST_F(Gone, IsNoSpeckAtTheEdgeOfTheView) {
  const OccupancyGrid beside = room_with({2.0, 7.0}, {2.1, 7.1});
  specks.take_map(room());
  specks.take_map(beside);
  look(room(), beside);
  EXPECT_EQ(missed(), 0U);
}

TEST_F(Gone, IsNothingThinThatTheFirstMapHadAlready) {
  specks.take_map(speck);
  specks.take_map(speck);
  look(room(), speck);
  EXPECT_EQ(missed(), 0U);
}

TEST_F(Gone, IsNoSurfaceByItsSpecks) {
  const OccupancyGrid face = room_with({4.0, 4.0}, {4.1, 6.0});
  specks.take_map(room());
  specks.take_map(face);
  look(room(), face);
  EXPECT_EQ(missed(), 0U);
}

TEST_F(Gone, IsTheWholeFaceBetweenTheBeamsThatPassIt) {
  const OccupancyGrid face = room_with({8.0, 4.0}, {8.1, 6.0});
  look(room(), face, {0.5, 5.0, 0.0});
  VoteLayer layer{{}, face.geometry()};
  const WatchList watched{{}, layer.blocks()};
  BeamVotes votes;
  const FaceParams params{.slant = 3.0, .bearing_step_rad = tracked.scan.bearing_step_rad};
  const Blocks gone = votes.of(beams, {}, {clear, layer, watched}, params).yes[static_cast<int>(Question::kRemoved)];
  int in_the_middle = 0;  // beams are 13 cm apart there, blocks 10 cm wide
  for (const std::uint32_t block : gone) {
    const Point2 centre = layer.blocks().centre_of(layer.blocks().cell_of(block));
    in_the_middle += std::abs(centre.y() - 5.0) < 0.5 ? 1 : 0;
    EXPECT_TRUE(clear.is_solid(layer.blocks().cell_of(block)));
  }
  EXPECT_EQ(in_the_middle, 10);
}

TEST_F(Gone, IsNothingBetweenBeamsThatPassTwoDifferentThings) {
  OccupancyGrid map = room_with({8.0, 4.0}, {8.1, 4.9});
  test::fill(map, {5.0, 5.1}, {5.1, 6.0}, CellState::kOccupied);
  test::fill(map, {6.5, 4.9}, {6.6, 5.1}, CellState::kOccupied);  // stands between them, as it did
  OccupancyGrid world = room();
  test::fill(world, {6.5, 4.9}, {6.6, 5.1}, CellState::kOccupied);
  look(world, map);
  VoteLayer layer{{}, map.geometry()};
  const WatchList watched{{}, layer.blocks()};
  BeamVotes votes;
  const FaceParams params{.slant = 3.0, .bearing_step_rad = tracked.scan.bearing_step_rad};
  for (const std::uint32_t block : votes.of(beams, {}, {clear, layer, watched}, params).yes[1]) {
    const Point2 centre = layer.blocks().centre_of(layer.blocks().cell_of(block));
    EXPECT_GT(std::abs(centre.x() - 6.55), 0.1);
  }
}

}  // namespace
}  // namespace deltamap::mapping::awareness
