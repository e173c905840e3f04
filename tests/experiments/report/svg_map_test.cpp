// SPDX-License-Identifier: Apache-2.0
// Maps and trajectories as SVG.
#include "experiments/report/svg_map.hpp"

#include <gtest/gtest.h>

#include <array>
#include <string>

namespace deltamap::experiments {
namespace {

TEST(MapPicture, TellsTheSurfacesOfTwoMapsApart) {
  OccupancyGrid one{GridGeometry{3, 1, 0.1, {0.0, 0.0}}};
  OccupancyGrid other = one;
  one.set({0, 0}, CellState::kOccupied);
  one.set({1, 0}, CellState::kOccupied);
  other.set({1, 0}, CellState::kOccupied);
  other.set({2, 0}, CellState::kOccupied);
  const std::string svg = svg_of_difference(one, other);
  EXPECT_NE(svg.find("<path fill=\"#1f5fa8\" d=\"M0 0h1v1h-1z\"/>"), std::string::npos) << svg;
  EXPECT_NE(svg.find("<path fill=\"#444444\" d=\"M1 0h1v1h-1z\"/>"), std::string::npos) << svg;
  EXPECT_NE(svg.find("<path fill=\"#c4531c\" d=\"M2 0h1v1h-1z\"/>"), std::string::npos) << svg;
}

TEST(MapPicture, DrawsTrajectoriesInTheCellsOfTheMap) {
  const OccupancyGrid map{GridGeometry{30, 20, 0.1, {-1.0, -1.0}}};
  const Trajectory robot{{{-1.0, -1.0}, {-1.0, -1.0}, {0.0, 0.5}}, "#0b7a75"};
  const Trajectory nothing{{}, "#a3218e"};
  const std::string svg = svg_of_difference(map, map, std::array{robot, nothing});
  EXPECT_NE(svg.find("stroke=\"#0b7a75\""), std::string::npos) << svg;
  EXPECT_NE(svg.find("d=\"M0.0 20.0L10.0 5.0\""), std::string::npos) << "row 0 is at the bottom: " << svg;
  EXPECT_NE(svg.find("d=\"\""), std::string::npos) << "a robot that never knew where it was: " << svg;
}

}  // namespace
}  // namespace deltamap::experiments
