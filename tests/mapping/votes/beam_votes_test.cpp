// SPDX-License-Identifier: Apache-2.0
#include "mapping/votes/beam_votes.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/mapping/seen_room.hpp"

namespace deltamap::mapping::votes {
namespace {

TEST(BeamVotes, TakeForGoneTheWholeFaceBetweenTheBeamsThatPassIt) {
  const OccupancyGrid face = room_with({8.0, 4.0}, {8.1, 6.0});
  const SeenRoom seen = seen_room(room(), face, {0.5, 5.0, 0.0});
  VoteLayer layer{{}, face.geometry()};
  const RedrawQueue watched{{}, layer.blocks()};
  BeamVotes votes;
  const Blocks gone = votes.of(seen.beams, {}, {seen.clear, layer, watched}, seen.tracked.scan.bearing_step_rad)
                          .yes[static_cast<int>(Question::kRemoved)];
  int in_the_middle = 0;  // beams are 13 cm apart there, blocks 10 cm wide
  for (const std::uint32_t block : gone) {
    const Point2 centre = layer.blocks().centre_of(layer.blocks().cell_of(block));
    in_the_middle += std::abs(centre.y() - 5.0) < 0.5 ? 1 : 0;
    EXPECT_TRUE(seen.clear.is_solid(layer.blocks().cell_of(block)));
  }
  EXPECT_EQ(in_the_middle, 10);
}

TEST(BeamVotes, TakeNothingForGoneBetweenBeamsThatPassTwoDifferentThings) {
  OccupancyGrid map = room_with({8.0, 4.0}, {8.1, 4.9});
  test::fill(map, {5.0, 5.1}, {5.1, 6.0}, CellState::kOccupied);
  test::fill(map, {6.5, 4.9}, {6.6, 5.1}, CellState::kOccupied);  // stands between them, as it did
  OccupancyGrid world = room();
  test::fill(world, {6.5, 4.9}, {6.6, 5.1}, CellState::kOccupied);
  const SeenRoom seen = seen_room(world, map);
  VoteLayer layer{{}, map.geometry()};
  const RedrawQueue watched{{}, layer.blocks()};
  BeamVotes votes;
  for (const std::uint32_t block :
       votes.of(seen.beams, {}, {seen.clear, layer, watched}, seen.tracked.scan.bearing_step_rad)
           .yes[static_cast<int>(Question::kRemoved)]) {
    const Point2 centre = layer.blocks().centre_of(layer.blocks().cell_of(block));
    EXPECT_GT(std::abs(centre.x() - 6.55), 0.1);
  }
}

}  // namespace
}  // namespace deltamap::mapping::votes
