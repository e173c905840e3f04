// SPDX-License-Identifier: Apache-2.0
#include "surveying/slam/seen_space.hpp"

#include <algorithm>

#include "core/geometry/points_in_map.hpp"
#include "core/grid/grid_ray.hpp"
#include "surveying/slam/drawn_map.hpp"

namespace deltamap::surveying::slam {
namespace {

constexpr double kSeenCellM = 0.1;
constexpr double kSeenLongestM = 12.0;  // beyond, neighbouring beams leave cells out
constexpr std::size_t kEachBeam = 4;    // of these one is looked at
constexpr double kBeforeEndM = 0.3;     // a beam may touch what it ends on

}  // namespace

SeenSpace::SeenSpace(const Survey& survey, std::span<const std::uint32_t> nodes, std::uint32_t frame)
    : seen_{drawn_map(survey, nodes, inverse(survey.poses[frame]), kSeenCellM, {.longest_m = kSeenLongestM})} {}

bool SeenSpace::is_solid_near(Cell cell) const {
  for (int row = cell.row - 1; row <= cell.row + 1; ++row) {
    for (int column = cell.column - 1; column <= cell.column + 1; ++column) {
      if (seen_.at({column, row}) == CellState::kOccupied) return true;
    }
  }
  return false;
}

double SeenSpace::contradicted(const Survey& survey, std::span<const std::uint32_t> nodes, std::uint32_t frame_of_nodes,
                               const Pose2& seen_from_frame_of_nodes) const {
  std::size_t looked_at = 0;
  std::size_t against = 0;
  for (const std::uint32_t node : nodes) {
    const TrackedScan tracked = survey.keyframes[node].scan.tracked();
    const PointsInMap in_seen{seen_from_frame_of_nodes *
                              motion_between(survey.poses[frame_of_nodes], survey.poses[node])};
    const std::size_t beams = std::min(tracked.rays.size(), tracked.scan.beams.size());
    for (std::size_t i = 0; i < beams; i += kEachBeam) {
      if (tracked.scan.beams[i].kind != BeamKind::kRange || tracked.scan.beams[i].range_m > kSeenLongestM) continue;
      const Point2 origin = in_seen(tracked.rays[i].origin);
      const Point2 end = in_seen(tracked.rays[i].end);
      const double length_m = (end - origin).norm();
      const Cell last = seen_.geometry().cell_at(end);
      bool through = false;
      walk_ray(seen_.geometry(), origin, end, [&](Cell cell, double entered_m) {
        if (entered_m > length_m - kBeforeEndM) return false;
        through = seen_.at(cell) == CellState::kOccupied;
        return !through;
      });
      const bool solid = is_solid_near(last);
      if (!through && !solid && seen_.at(last) == CellState::kUnknown) continue;
      ++looked_at;
      against += through || !solid ? 1 : 0;
    }
  }
  return looked_at == 0 ? 1.0 : static_cast<double>(against) / static_cast<double>(looked_at);
}

}  // namespace deltamap::surveying::slam
