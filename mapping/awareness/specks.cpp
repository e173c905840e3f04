// SPDX-License-Identifier: Apache-2.0
#include "mapping/awareness/specks.hpp"

#include <algorithm>
#include <cmath>

#include "core/angle.hpp"
#include "mapping/awareness/pose_deviation.hpp"

namespace deltamap::mapping::awareness {
namespace {

CellBox box_around(const std::vector<Cell>& cells) {
  CellBox box{cells.front(), cells.front()};
  for (const Cell& cell : cells) {
    box.first = {std::min(box.first.column, cell.column), std::min(box.first.row, cell.row)};
    box.last = {std::max(box.last.column, cell.column + 1), std::max(box.last.row, cell.row + 1)};
  }
  return box;
}

/// Across the line of sight, m: from the first cell to the last, and one cell.
double width_m(const std::vector<Cell>& cells, const GridGeometry& geometry, const Point2& sight) {
  const Point2 across{-sight.y(), sight.x()};
  const auto aside = [&](const Cell& cell) { return geometry.centre_of(cell).dot(across); };
  const auto [least, most] = std::minmax_element(cells.begin(), cells.end(),
                                                 [&](const Cell& a, const Cell& b) { return aside(a) < aside(b); });
  return aside(*most) - aside(*least) + geometry.resolution_m;
}

}  // namespace

std::vector<Cell> Specks::take_group(const OccupancyGrid& map, Cell start) {
  std::vector<Cell> group;
  const auto take = [&](Cell cell) {
    if (map.at(cell) != CellState::kOccupied) return;
    Flags& flags = flags_[geometry_.index_of(cell)];
    if ((flags & kTaken) == 0) group.push_back(cell);
    flags |= kTaken;
  };
  take(start);
  for (std::size_t next = 0; next < group.size(); ++next) {
    const Cell middle = group[next];
    for (int row = middle.row - 1; row <= middle.row + 1; ++row) {
      for (int column = middle.column - 1; column <= middle.column + 1; ++column) take({column, row});
    }
  }
  return group;
}

void Specks::take_map(const OccupancyGrid& map) {
  const bool is_first = geometry_ != map.geometry();
  geometry_ = map.geometry();
  specks_.clear();
  if (is_first) flags_.assign(geometry_.cell_count(), 0);
  for (Flags& flags : flags_) flags &= kThin;
  const auto most_cells = static_cast<int>(params_.most_side_m / geometry_.resolution_m);
  const std::vector<CellState>& cells = map.cells();
  const auto occupied_from = [&](auto place) { return std::find(place, cells.end(), CellState::kOccupied); };
  for (auto place = occupied_from(cells.begin()); place != cells.end(); place = occupied_from(place + 1)) {
    const auto index = static_cast<std::size_t>(place - cells.begin());
    if ((flags_[index] & kTaken) != 0) continue;
    std::vector<Cell> group = take_group(map, geometry_.cell_of(index));
    const CellBox box = box_around(group);
    if (std::max(box.width(), box.height()) > most_cells) continue;
    const auto flags_of = [&](Cell cell) -> Flags& { return flags_[geometry_.index_of(cell)]; };
    if (is_first)
      for (const Cell& cell : group) flags_of(cell) |= kThin;
    if (std::any_of(group.begin(), group.end(), [&](Cell cell) { return (flags_of(cell) & kThin) != 0; })) continue;
    for (const Cell& cell : group) flags_of(cell) |= kOfSpeck;
    const Point2 first = geometry_.centre_of(box.first);
    const Point2 last = geometry_.centre_of({box.last.column - 1, box.last.row - 1});
    specks_.push_back({0.5 * (first + last), 0.5 * ((last - first).norm() + geometry_.resolution_m), std::move(group)});
  }
}

std::vector<Cell> Specks::missed(const TrackedScan& tracked, std::span<const BeamVerdict> beams,
                                 const BeamEvidenceParams& params) const {
  std::vector<Cell> cells;
  const PoseDeviation deviation = pose_deviation(tracked.estimate, tracked.turn_rate_rad_per_s, params);
  for (const Speck& speck : specks_) {
    if (is_missed(speck, tracked, beams, deviation, params))
      cells.insert(cells.end(), speck.cells.begin(), speck.cells.end());
  }
  return cells;
}

bool Specks::is_missed(const Speck& speck, const TrackedScan& tracked, std::span<const BeamVerdict> beams,
                       const PoseDeviation& deviation, const BeamEvidenceParams& params) const {
  const Scan& scan = tracked.scan;
  const Pose2 laser = tracked.estimate.map_from_robot * scan.robot_from_laser;
  const Point2 way = speck.middle - laser.position();
  const double distance_m = way.norm();
  if (distance_m > params.most_range_m || distance_m <= speck.radius_m) return false;
  const double step_m = distance_m * scan.bearing_step_rad;
  if (step_m > params_.most_step * width_m(speck.cells, geometry_, way / distance_m)) return false;
  const double bearing_rad = wrapped_angle(std::atan2(way.y(), way.x()) - laser.theta);
  const double aside_m = speck.radius_m + params.deviations * deviation.aside_m(distance_m);
  const double half_rad = aside_m / distance_m;
  const double first = std::floor((bearing_rad - half_rad - scan.first_bearing_rad) / scan.bearing_step_rad);
  const double last = std::ceil((bearing_rad + half_rad - scan.first_bearing_rad) / scan.bearing_step_rad);
  if (first < 0.0 || last >= static_cast<double>(beams.size())) return false;
  const double beyond_m = distance_m + aside_m + params.beyond_m;
  return std::all_of(beams.begin() + static_cast<std::ptrdiff_t>(first),
                     beams.begin() + static_cast<std::ptrdiff_t>(last) + 1,
                     [&](const BeamVerdict& beam) { return beam.length_m >= beyond_m; });
}

}  // namespace deltamap::mapping::awareness
