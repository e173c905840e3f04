// SPDX-License-Identifier: Apache-2.0
#include "mapping/ray_counts.hpp"

#include <algorithm>
#include <limits>
#include <utility>

#include "core/points_in_map.hpp"
#include "mapping/box_walk.hpp"

namespace deltamap::mapping {
namespace {

struct BeamInMap {
  Point2 from;
  Point2 end;
  double length_m = 0.0;
  bool hits = true;
};

/// The beam in the map, cut at `longest_m`.
BeamInMap beam_in_map(const PointsInMap& in_map, const RayInRobot& ray, double longest_m) {
  const Point2 from = in_map(ray.origin);
  const Point2 end = in_map(ray.end);
  const double length_m = (end - from).norm();
  if (length_m <= longest_m) return {from, end, length_m, true};
  return {from, from + (end - from) * (longest_m / length_m), longest_m, false};
}

/// `visit(BeamInMap)` for each beam of the scan that has a range.
template <typename Visit>
void for_each_beam(const PlacedScan& scan, double longest_m, Visit&& visit) {
  const PointsInMap in_map{scan.map_from_robot};
  for (std::size_t i = 0; i < scan.tracked->rays.size(); ++i) {
    if (scan.tracked->scan.beams[i].kind == BeamKind::kRange) {
      visit(beam_in_map(in_map, scan.tracked->rays[i], longest_m));
    }
  }
}

}  // namespace

RayCounts::RayCounts(const GridGeometry& map, const CellBox& box)
    : map_{map},
      box_{box},
      counts_(box.empty() ? 0 : static_cast<std::size_t>(box.width()) * static_cast<std::size_t>(box.height())),
      walls_(counts_.size(), CellState::kUnknown) {}

void RayCounts::stop_at(const OccupancyGrid& walls, std::function<bool(Cell)> stops) {
  for (int row = box_.first.row; row < box_.last.row; ++row) {
    const Cell first{box_.first.column, row};
    const auto begin = walls.cells().begin() + static_cast<std::ptrdiff_t>(walls.geometry().index_of(first));
    std::copy(begin, begin + box_.width(), walls_.begin() + static_cast<std::ptrdiff_t>(index_of(first)));
  }
  stops_ = std::move(stops);
  is_opaque_.assign(counts_.size(), 0);
}

bool RayCounts::stops_in(std::size_t index) {
  if (is_opaque_[index] != 0) return true;
  const auto width = static_cast<std::size_t>(box_.width());
  const Cell cell{box_.first.column + static_cast<int>(index % width),
                  box_.first.row + static_cast<int>(index / width)};
  const bool stops = stops_(cell);
  is_opaque_[index] = stops ? 1 : 0;
  if (!stops) walls_[index] = CellState::kFree;  // is not asked again
  return stops;
}

bool RayCounts::passes_to_end(BoxWalk& walk, double clear_end_m) {
  while (!walk.is_at_end()) {
    RayCount& count = counts_[walk.index()];
    ++count.passes;
    if (walk.entered_m() < clear_end_m) {
      ++count.clear_passes;
      if (walls_[walk.index()] == CellState::kOccupied && stops_in(walk.index())) return false;
    }
    if (!walk.goes_on()) return false;
  }
  return true;
}

void RayCounts::add(const PlacedScan& scan, double longest_m, double clear_m) {
  for_each_beam(scan, longest_m, [&](const BeamInMap& beam) {
    if (!box_.contains(map_.cell_at(beam.from))) return;
    BoxWalk walk{map_, box_, beam.from, beam.end};
    if (passes_to_end(walk, beam.length_m - clear_m) && beam.hits) ++counts_[walk.index()].hits;
  });
}

OccupancyGrid RayCounts::local_map(double least_hit_share) const {
  const Point2 corner = map_.origin + map_.resolution_m * Point2{box_.first.column, box_.first.row};
  OccupancyGrid local{{std::max(0, box_.width()), std::max(0, box_.height()), map_.resolution_m, corner}};
  for (std::size_t i = 0; i < counts_.size(); ++i) {
    if (counts_[i].seen() == 0) continue;
    const bool occupied = counts_[i].hit_share() >= least_hit_share;
    local.set(local.geometry().cell_of(i), occupied ? CellState::kOccupied : CellState::kFree);
  }
  return local;
}

CellBox box_seen(const GridGeometry& map, std::span<const PlacedScan> scans, double longest_m) {
  constexpr double kFar = std::numeric_limits<double>::infinity();
  Point2 low{kFar, kFar};
  Point2 high{-kFar, -kFar};
  for (const PlacedScan& scan : scans) {
    for_each_beam(scan, longest_m, [&](const BeamInMap& beam) {
      low = low.cwiseMin(beam.from).cwiseMin(beam.end);
      high = high.cwiseMax(beam.from).cwiseMax(beam.end);
    });
  }
  if (!(low.x() <= high.x())) return {};
  const Cell last = map.cell_at(high);
  return grown({map.cell_at(low), {last.column + 1, last.row + 1}}, 0, map);
}

}  // namespace deltamap::mapping
