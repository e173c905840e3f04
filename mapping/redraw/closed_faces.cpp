// SPDX-License-Identifier: Apache-2.0
// Why: far away, neighbouring beams end cells apart, so a new straight face would be drawn as single dots, between
// which a planner would see gaps.
#include "mapping/redraw/closed_faces.hpp"

#include <algorithm>
#include <cstddef>

#include "core/geometry/points_in_map.hpp"
#include "core/grid/grid_ray.hpp"
#include "mapping/votes/face_step.hpp"

namespace deltamap::mapping::redraw {
namespace {

/// Of the cell and its eight neighbours, those that `is_drawn`. For a gap of one cell in a line it is two.
template <typename IsDrawn>
int count_drawn_around(Cell cell, IsDrawn&& is_drawn) {
  int drawn = 0;
  for (int row = cell.row - 1; row <= cell.row + 1; ++row) {
    for (int column = cell.column - 1; column <= cell.column + 1; ++column) drawn += is_drawn({column, row}) ? 1 : 0;
  }
  return drawn;
}

/// A cell left out of a straight line of cells.
template <typename IsGap>
std::vector<Cell> pinholes(const OccupancyGrid& map, const CellBox& box, IsGap&& is_gap) {
  std::vector<Cell> holes;
  const auto is_occupied = [&](int column, int row) { return map.at({column, row}) == CellState::kOccupied; };
  for (int row = box.first.row; row < box.last.row; ++row) {
    for (int column = box.first.column; column < box.last.column; ++column) {
      const bool level = is_occupied(column - 1, row) && is_occupied(column + 1, row);
      const bool upright = is_occupied(column, row - 1) && is_occupied(column, row + 1);
      if (level == upright) continue;
      const bool beside = level ? is_occupied(column, row - 1) || is_occupied(column, row + 1)
                                : is_occupied(column - 1, row) || is_occupied(column + 1, row);
      if (!beside && is_gap({column, row})) holes.push_back({column, row});
    }
  }
  return holes;
}

/// The beams of one scan by their ends in the map.
struct ScanEnds {
  std::vector<Point2> ends;
  std::vector<double> lengths_m;  // 0 where the beam ends on no face
};

ScanEnds ends_of(const PlacedScan& scan, double longest_m) {
  ScanEnds ends;
  ends.ends.reserve(scan.tracked->rays.size());
  ends.lengths_m.reserve(scan.tracked->rays.size());
  const PointsInMap in_map{scan.map_from_robot};
  for (std::size_t i = 0; i < scan.tracked->rays.size(); ++i) {
    const Beam& beam = scan.tracked->scan.beams[i];
    ends.ends.push_back(in_map(scan.tracked->rays[i].end));
    const bool counts = beam.kind == BeamKind::kRange && beam.range_m <= longest_m;
    ends.lengths_m.push_back(counts ? static_cast<double>(beam.range_m) : 0.0);
  }
  return ends;
}

/// `visit(end, end of the next beam)` for the steps on one face of which any end is drawn, as far as that is known
/// beforehand: most beams of a scan end elsewhere.
template <typename IsDrawn, typename Visit>
void for_each_step_near(const ScanEnds& scan, double bearing_step_rad, IsDrawn&& is_near, Visit&& visit) {
  const std::vector<Point2>& ends = scan.ends;
  const auto first = std::find_if(ends.begin(), ends.end(), is_near);
  if (first == ends.end()) return;
  const auto last = std::find_if(ends.rbegin(), ends.rend(), is_near).base();  // behind it
  // What decides on a step reaches one beam farther on both sides.
  const std::ptrdiff_t begin = std::max<std::ptrdiff_t>(0, first - ends.begin() - 1);
  const std::ptrdiff_t end = std::min(std::ssize(ends), last - ends.begin() + 1);
  const auto at = [&](std::size_t i) { return static_cast<std::size_t>(begin) + i; };
  votes::for_each_face_step(
      static_cast<std::size_t>(end - begin), bearing_step_rad, [&](std::size_t i) { return scan.lengths_m[at(i)]; },
      [&](std::size_t i) { return ends[at(i)]; }, [&](std::size_t i) { visit(ends[at(i)], ends[at(i + 1)]); });
}

}  // namespace

MapDraft with_closed_faces(MapDraft draft, const RayCounts& counts, const std::vector<PlacedScan>& scans,
                           const CellBox& box, const std::function<bool(Cell)>& may_be_added,
                           const ClosedFacesParams& params) {
  const OccupancyGrid& map = draft.map();
  const GridGeometry& geometry = map.geometry();
  std::vector<Cell> closed;
  const auto may_be_face = [&](const Point2& end) {
    const Cell cell = geometry.cell_at(end);
    return box.contains(cell) && may_be_added(cell);
  };
  const auto is_face = [&](const Point2& end) {
    return may_be_face(end) && map.at(geometry.cell_at(end)) == CellState::kOccupied;
  };
  const auto is_drawn = [&](Cell cell) {
    return map.at(cell) == CellState::kOccupied && std::find(closed.begin(), closed.end(), cell) == closed.end();
  };
  const auto is_gap = [&](Cell cell) {
    return map.at(cell) != CellState::kOccupied && may_be_added(cell) && counts.box().contains(cell) &&
           counts[cell].clear_passes < params.free_passes && count_drawn_around(cell, is_drawn) <= 2;
  };
  for (const PlacedScan& scan : scans) {
    const double bearing_step_rad = scan.tracked->scan.bearing_step_rad;
    for_each_step_near(ends_of(scan, params.longest_m), bearing_step_rad, may_be_face,
                       [&](const Point2& one, const Point2& next) {
                         if (!is_face(one) || !is_face(next)) return;
                         walk_ray(geometry, one, next, [&](Cell cell, double) {
                           if (!is_gap(cell)) return true;
                           draft.set(cell, CellState::kOccupied);
                           closed.push_back(cell);
                           return true;
                         });
                       });
  }
  for (const Cell& hole : pinholes(map, box, is_gap)) draft.set(hole, CellState::kOccupied);
  return draft;
}

}  // namespace deltamap::mapping::redraw
