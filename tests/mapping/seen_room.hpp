// SPDX-License-Identifier: Apache-2.0
// A room with one wall, what may stand in it, and what a robot sees there: for tests of what beams show to be gone.
#pragma once

#include <vector>

#include "mapping/votes/beam_evidence.hpp"
#include "mapping/votes/clear_space.hpp"
#include "tests/support/scans/seen_scan.hpp"
#include "tests/support/worlds/drawn_hall.hpp"

namespace deltamap::mapping {

inline OccupancyGrid room() {
  OccupancyGrid room{{200, 200, 0.05, {0.0, 0.0}}, CellState::kFree};
  test::fill(room, {9.8, 0.0}, {9.9, 10.0}, CellState::kOccupied);
  return room;
}

inline OccupancyGrid room_with(Point2 low, Point2 high) {
  OccupancyGrid with = room();
  test::fill(with, low, high, CellState::kOccupied);
  return with;
}

/// A scan, and what its beams say about the map.
struct SeenRoom {
  TrackedScan tracked;
  votes::ClearSpace clear;
  std::vector<votes::BeamVerdict> beams;
};

/// What the robot sees of `world`, without noise.
inline SeenRoom seen_room(const OccupancyGrid& world, const OccupancyGrid& map, const Pose2& robot = {2.0, 5.0, 0.0}) {
  Random random{1};
  SeenRoom seen;
  seen.tracked = test::seen_scan(world, robot, 0.0, random);
  seen.clear = votes::ClearSpace{map, {map.geometry(), 2}};
  seen.beams = votes::beam_evidence(map, seen.clear, seen.tracked, {});
  return seen;
}

}  // namespace deltamap::mapping
