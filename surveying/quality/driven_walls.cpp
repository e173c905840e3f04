// SPDX-License-Identifier: Apache-2.0
#include "surveying/quality/driven_walls.hpp"

#include <algorithm>
#include <cmath>

#include "core/grid/grid_ray.hpp"

namespace deltamap::surveying::quality {
namespace {

constexpr double kLongestStepM = 1.5;      // between two scans: beyond, the robot did not go straight
constexpr float kLeastCrossedSine = 0.5F;  // 30° to the wall
constexpr double kSameWallM = 2.0;         // the width of a double door
constexpr int kFewestPasses = 2;           // that have seen it: a door that was shut once is no wall
constexpr float kGoesOnM = 0.4F;           // to either side the wall goes on: it is no person who stood there

bool has_wall_near(const SeenWalls& walls, const Point2& place, std::uint32_t pass) {
  const Cell middle = walls.geometry().cell_at(place);
  for (int row = middle.row - 1; row <= middle.row + 1; ++row) {
    for (int column = middle.column - 1; column <= middle.column + 1; ++column) {
      const auto of = walls.at({column, row});
      if (std::any_of(of.begin(), of.end(), [&](const SeenWalls::Wall& wall) { return wall.pass == pass; }))
        return true;
    }
  }
  return false;
}

bool goes_on(const SeenWalls& walls, const SeenWalls::Wall& wall, const Point2& place) {
  const Point2 along = kGoesOnM * Point2{-wall.normal.y(), wall.normal.x()};
  return has_wall_near(walls, place + along, wall.pass) && has_wall_near(walls, place - along, wall.pass);
}

}  // namespace

std::vector<Point2> driven_walls(std::span<const PlacedScan> scans, std::span<const Pass> passes,
                                 const SeenWalls& walls) {
  std::vector<Point2> places;
  for (std::uint32_t i = 0; i < passes.size(); ++i) {
    for (std::uint32_t k = passes[i].first; k < passes[i].last; ++k) {
      const Point2 from = scans[k].map_from_robot.position();
      const Point2 to = scans[k + 1].map_from_robot.position();
      const double length_m = (to - from).norm();
      if (length_m <= 0.0 || length_m > kLongestStepM) continue;
      const Eigen::Vector2f direction = ((to - from) / length_m).cast<float>();
      walk_ray(walls.geometry(), from, to, [&](Cell cell, double) {
        const auto of = walls.at(cell);
        const Point2 place = walls.geometry().centre_of(cell);
        const auto seen_by = std::count_if(of.begin(), of.end(), [&](const SeenWalls::Wall& wall) {
          return wall.pass != i && std::abs(wall.normal.dot(direction)) >= kLeastCrossedSine &&
                 goes_on(walls, wall, place);
        });
        if (seen_by >= kFewestPasses && std::none_of(places.begin(), places.end(), [&](const Point2& other) {
              return (place - other).norm() < kSameWallM;
            })) {
          places.push_back(place);
        }
        return true;
      });
    }
  }
  return places;
}

}  // namespace deltamap::surveying::quality
