// SPDX-License-Identifier: Apache-2.0
// Why clear passes are counted apart: with noise of some centimetres, a beam that ends just behind a cell may have met
// what stands in it. Only a beam that goes on well beyond the cell speaks against it.
#include "mapping/redraw/ray_counts.hpp"

#include <algorithm>
#include <limits>
#include <utility>

#include "core/geometry/points_in_map.hpp"
#include "core/geometry/pose_spread.hpp"
#include "core/grid/grid_ray.hpp"

namespace deltamap::mapping::redraw {
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

/// Does the way from one point to the other touch the box?
bool touches(const GridGeometry& map, const CellBox& box, const Point2& from, const Point2& to) {
  double first = 0.0;  // shares of the way: in the box from here …
  double last = 1.0;   // … to here
  const auto cut = [&](double start, double delta, double low, double high) {
    if (delta == 0.0) {
      if (start < low || start > high) last = -1.0;
      return;
    }
    const auto [in, out] = std::minmax({(low - start) / delta, (high - start) / delta});
    first = std::max(first, in);
    last = std::min(last, out);
  };
  const Point2 way = to - from;
  const double r = map.resolution_m;
  cut(from.x(), way.x(), map.origin.x() + box.first.column * r, map.origin.x() + box.last.column * r);
  cut(from.y(), way.y(), map.origin.y() + box.first.row * r, map.origin.y() + box.last.row * r);
  return first <= last;
}

}  // namespace

RayCounts::RayCounts(const GridGeometry& map, const CellBox& box)
    : map_{map},
      box_{box},
      marks_(box.cell_count(), kUnseen),
      counts_{std::make_unique_for_overwrite<Count[]>(marks_.size())},
      seen_{std::make_unique_for_overwrite<std::uint32_t[]>(marks_.size())} {}

void RayCounts::stop_at(const OccupancyGrid& walls, std::function<bool(Cell)> stops) {
  walls_ = &walls;
  stops_ = std::move(stops);
}

bool RayCounts::stops(std::size_t index) {
  if (marks_[index] == kWall) marks_[index] = stops_(cell_of(index)) ? kOpaque : kOpen;
  return marks_[index] == kOpaque;
}

void RayCounts::add_beam(const Point2& from, const Point2& end, double clear_end_m, bool hits) {
  const Cell last = map_.cell_at(end);
  bool stopped = false;
  walk_ray(map_, from, end, [&](Cell cell, double entered_m) {
    if (cell == last || !box_.contains(cell)) return true;
    const std::size_t index = box_.index_of(cell);
    see(index);
    if (entered_m >= clear_end_m) {
      ++counts_[index].late_passes;
      return true;
    }
    ++counts_[index].clear_passes;
    stopped = marks_[index] != kOpen && stops(index);
    return !stopped;
  });
  if (stopped || !hits || !box_.contains(last)) return;
  const std::size_t index = box_.index_of(last);
  see(index);
  ++counts_[index].hits;
}

void RayCounts::add(const PlacedScan& scan, double longest_m) {
  for_each_beam(scan, longest_m, [&](const BeamInMap& beam) {
    if (part_ && !touches(map_, *part_, beam.from, beam.end)) return;
    add_beam(beam.from, beam.end, beam.length_m - kClearlyBeyondM, beam.hits);
  });
}

CellBox box_seen(const GridGeometry& map, std::span<const PlacedScan> scans, double longest_m,
                 const std::optional<CellBox>& part) {
  Point2 low = Point2::Constant(std::numeric_limits<double>::infinity());
  Point2 high = -low;
  for (const PlacedScan& scan : scans) {
    for_each_beam(scan, longest_m, [&](const BeamInMap& beam) {
      if (part && !touches(map, *part, beam.from, beam.end)) return;
      low = low.cwiseMin(beam.from).cwiseMin(beam.end);
      high = high.cwiseMax(beam.from).cwiseMax(beam.end);
    });
  }
  if (!(low.x() <= high.x())) return {};
  const Cell last = map.cell_at(high);
  return grown({map.cell_at(low), {last.column + 1, last.row + 1}}, 0, map);
}

}  // namespace deltamap::mapping::redraw
