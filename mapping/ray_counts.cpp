// SPDX-License-Identifier: Apache-2.0
#include "mapping/ray_counts.hpp"

#include <algorithm>
#include <limits>
#include <utility>

#include "core/grid_ray.hpp"

namespace deltamap::mapping {
namespace {

void count_up(std::uint16_t& count) {
  if (count < std::numeric_limits<std::uint16_t>::max()) ++count;
}

struct BeamInMap {
  Point2 from;
  Point2 end;
  bool hits = true;
};

/// The beam in the map, cut at `longest_m`.
BeamInMap beam_in_map(const PlacedScan& scan, std::size_t beam, double longest_m) {
  const RayInRobot& ray = scan.tracked->rays[beam];
  const Point2 from = scan.map_from_robot * Point2{ray.origin.cast<double>()};
  const Point2 end = scan.map_from_robot * Point2{ray.end.cast<double>()};
  const double length_m = (end - from).norm();
  if (length_m <= longest_m) return {from, end, true};
  return {from, from + (end - from) * (longest_m / length_m), false};
}

}  // namespace

RayCounts::RayCounts(const GridGeometry& map, const CellBox& box)
    : map_{map},
      box_{box},
      counts_(box.empty() ? 0 : static_cast<std::size_t>(box.width()) * static_cast<std::size_t>(box.height())) {}

void RayCounts::stop_at(const OccupancyGrid& walls, std::function<bool(Cell)> stops) {
  walls_ = &walls;
  stops_ = std::move(stops);
  opaque_.assign(counts_.size(), Opaque::kUnasked);
}

bool RayCounts::stops_in(Cell cell) {
  if (walls_ == nullptr || walls_->at(cell) != CellState::kOccupied) return false;
  Opaque& opaque = opaque_[index_of(cell)];
  if (opaque == Opaque::kUnasked) opaque = stops_(cell) ? Opaque::kYes : Opaque::kNo;
  return opaque == Opaque::kYes;
}

void RayCounts::add(const PlacedScan& scan, double longest_m, double clear_m) {
  for (std::size_t i = 0; i < scan.tracked->rays.size(); ++i) {
    if (scan.tracked->scan.beams[i].kind != BeamKind::kRange) continue;
    const BeamInMap beam = beam_in_map(scan, i, longest_m);
    const Cell last = map_.cell_at(beam.end);
    const double clear_end_m = (beam.end - beam.from).norm() - clear_m;
    bool stopped = false;
    walk_ray(map_, beam.from, beam.end, [&](Cell cell, double entered_m) {
      if (!box_.contains(cell) || cell == last) return true;
      RayCount& count = counts_[index_of(cell)];
      count_up(count.passes);
      if (entered_m < clear_end_m) count_up(count.clear_passes);
      stopped = entered_m < clear_end_m && stops_in(cell);
      return !stopped;
    });
    if (beam.hits && !stopped && box_.contains(last)) count_up(counts_[index_of(last)].hits);
  }
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
  CellBox box;
  const auto include = [&](const Point2& place) {
    const Cell cell = map.cell_at(place);
    if (box.empty()) box = {cell, {cell.column + 1, cell.row + 1}};
    box.first = {std::min(box.first.column, cell.column), std::min(box.first.row, cell.row)};
    box.last = {std::max(box.last.column, cell.column + 1), std::max(box.last.row, cell.row + 1)};
  };
  for (const PlacedScan& scan : scans) {
    for (std::size_t i = 0; i < scan.tracked->rays.size(); ++i) {
      if (scan.tracked->scan.beams[i].kind != BeamKind::kRange) continue;
      const BeamInMap beam = beam_in_map(scan, i, longest_m);
      include(beam.from);
      include(beam.end);
    }
  }
  return grown(box, 0, map);
}

}  // namespace deltamap::mapping
