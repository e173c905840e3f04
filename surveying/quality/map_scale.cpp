// SPDX-License-Identifier: Apache-2.0
#include "surveying/quality/map_scale.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include "core/geometry/points_in_map.hpp"
#include "mapping/registration/surface.hpp"

namespace deltamap::surveying::quality {
namespace {

constexpr std::size_t kEachEnd = 3;   // of these one is looked at
constexpr int kReachCells = 3;        // 3 % of ten metres
constexpr float kLeastCosine = 0.9F;  // between the normals: one and the same face

/// Of each pass, the face that is nearest to an end.
struct Nearest {
  std::uint32_t end = 0;  // number of the end that it is nearest to
  double off_m = 0.0;
  double lever_m = 0.0;
};

}  // namespace

MapScale map_scale(std::span<const PlacedScan> scans, std::span<const Pass> passes, const SeenWalls& walls) {
  double squares = 0.0;
  double products = 0.0;
  std::size_t looks = 0;
  std::uint32_t number = 0;
  std::vector<Nearest> nearest(passes.size());
  std::vector<std::uint32_t> found;
  for (std::uint32_t i = 0; i < passes.size(); ++i) {
    for (std::uint32_t k = passes[i].first; k <= passes[i].last; ++k) {
      const PointsInMap in_map{scans[k].map_from_robot};
      const Point2 robot = scans[k].map_from_robot.position();
      const auto surface = mapping::registration::surface_of(scans[k].scan->ends(kLongestSeenM));
      for (std::size_t e = k % kEachEnd; e < surface.size(); e += kEachEnd) {
        const Point2 end = in_map(surface[e].position);
        Point2 normal = Pose2{0.0, 0.0, scans[k].map_from_robot.theta} * surface[e].normal;
        if (normal.dot(robot - end) < 0.0) normal = -normal;
        ++number;
        found.clear();
        const Cell middle = walls.geometry().cell_at(end);
        for (int row = middle.row - kReachCells; row <= middle.row + kReachCells; ++row) {
          for (int column = middle.column - kReachCells; column <= middle.column + kReachCells; ++column) {
            for (const SeenWalls::Wall& wall : walls.at({column, row})) {
              if (wall.pass == i || wall.normal.dot(normal.cast<float>()) < kLeastCosine) continue;
              const double off_m = normal.dot(end - walls.geometry().centre_of({column, row}));
              Nearest& of = nearest[wall.pass];
              if (of.end == number && std::abs(of.off_m) <= std::abs(off_m)) continue;
              if (of.end != number) found.push_back(wall.pass);
              of = {number, off_m, normal.dot(robot - passes[wall.pass].middle)};
            }
          }
        }
        for (const std::uint32_t pass : found) {
          squares += nearest[pass].lever_m * nearest[pass].lever_m;
          products += nearest[pass].lever_m * nearest[pass].off_m;
          ++looks;
        }
      }
    }
  }
  if (looks == 0 || squares == 0.0) return {};
  return {products / squares, std::sqrt(squares / static_cast<double>(looks)), looks};
}

}  // namespace deltamap::surveying::quality
