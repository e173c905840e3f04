// SPDX-License-Identifier: Apache-2.0
#include "mapping/evidence/small_objects.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/geometry/angle.hpp"
#include "mapping/votes/pose_deviation.hpp"

namespace deltamap::mapping::evidence {
namespace {

/// Across the line of sight, m: from the first cell to the last, and one cell.
double width_m(const std::vector<Cell>& cells, const GridGeometry& geometry, const Point2& sight) {
  const Point2 across{-sight.y(), sight.x()};
  const auto aside = [&](const Cell& cell) { return geometry.centre_of(cell).dot(across); };
  const auto [least, most] = std::minmax_element(cells.begin(), cells.end(),
                                                 [&](const Cell& a, const Cell& b) { return aside(a) < aside(b); });
  return aside(*most) - aside(*least) + geometry.resolution_m;
}

}  // namespace

/// Stops where the group grows too wide to be a small object, or meets one that has.
std::optional<SmallObjects::Group> SmallObjects::small_group(const OccupancyGrid& map, Cell start) {
  const auto most_cells = static_cast<int>(params_.most_side_m / geometry_.resolution_m);
  std::vector<Cell> cells;
  CellBox box{start, start};
  bool is_small = true;
  const auto take = [&](Cell cell) {
    if (map.at(cell) != CellState::kOccupied) return;
    Flags& flags = flags_of(cell);
    if ((flags & kWide) != 0) is_small = false;
    if ((flags & kTaken) != 0) return;
    flags |= kTaken;
    cells.push_back(cell);
    box.first = {std::min(box.first.column, cell.column), std::min(box.first.row, cell.row)};
    box.last = {std::max(box.last.column, cell.column + 1), std::max(box.last.row, cell.row + 1)};
    if (std::max(box.width(), box.height()) > most_cells) is_small = false;
  };
  take(start);
  for (std::size_t next = 0; next < cells.size() && is_small; ++next) {
    const Cell middle = cells[next];
    for (int row = middle.row - 1; row <= middle.row + 1; ++row) {
      for (int column = middle.column - 1; column <= middle.column + 1; ++column) take({column, row});
    }
  }
  taken_.insert(taken_.end(), cells.begin(), cells.end());
  if (is_small) return Group{std::move(cells), box};
  for (const Cell& cell : cells) flags_of(cell) |= kWide;
  return std::nullopt;
}

void SmallObjects::gather(const OccupancyGrid& map, std::span<const Cell> starts) {
  for (const Cell& start : starts) {
    if (map.at(start) != CellState::kOccupied || (flags_of(start) & (kTaken | kWide)) != 0) continue;
    std::optional<Group> group = small_group(map, start);
    if (!group) continue;
    auto& [cells, box] = *group;
    if (std::any_of(cells.begin(), cells.end(), [&](Cell cell) { return (flags_of(cell) & kThin) != 0; })) continue;
    for (const Cell& cell : cells) flags_of(cell) |= kOfSmallObject;
    const Point2 first = geometry_.centre_of(box.first);
    const Point2 last = geometry_.centre_of({box.last.column - 1, box.last.row - 1});
    small_objects_.push_back(
        {0.5 * (first + last), 0.5 * ((last - first).norm() + geometry_.resolution_m), std::move(cells)});
  }
  for (const Cell& cell : taken_) flags_of(cell) &= static_cast<Flags>(~(kTaken | kWide));
  taken_.clear();
}

void SmallObjects::begin(const OccupancyGrid& map) {
  geometry_ = map.geometry();
  flags_ = Tiled<Flags>{geometry_.width, geometry_.height, Flags{0}};
  small_objects_.clear();
  std::vector<Cell> occupied;
  for_each_known(map, [&](Cell cell, CellState state) {
    if (state == CellState::kOccupied) occupied.push_back(cell);
  });
  gather(map, occupied);
  for (const SmallObject& object : small_objects_) {
    for (const Cell& cell : object.cells) flags_of(cell) = kThin;
  }
  small_objects_.clear();
}

void SmallObjects::follow(const OccupancyGrid& map, std::span<const CellChange> changes) {
  std::vector<Cell> starts;
  for (const CellChange& change : changes) {
    for (int row = change.cell.row - 1; row <= change.cell.row + 1; ++row) {
      for (int column = change.cell.column - 1; column <= change.cell.column + 1; ++column) {
        if (geometry_.contains({column, row})) starts.push_back({column, row});
      }
    }
  }
  for (const Cell& cell : starts) flags_of(cell) |= kTouched;
  const auto is_touched = [&](Cell cell) { return (flags_of(cell) & kTouched) != 0; };
  const std::size_t around_changes = starts.size();
  std::erase_if(small_objects_, [&](const SmallObject& object) {
    if (std::none_of(object.cells.begin(), object.cells.end(), is_touched)) return false;
    for (const Cell& cell : object.cells) flags_of(cell) &= static_cast<Flags>(~kOfSmallObject);
    starts.insert(starts.end(), object.cells.begin(), object.cells.end());
    return true;
  });
  for (std::size_t i = 0; i < around_changes; ++i) flags_of(starts[i]) &= static_cast<Flags>(~kTouched);
  gather(map, starts);
}

std::vector<Cell> SmallObjects::missed(const TrackedScan& tracked, std::span<const votes::BeamVerdict> beams,
                                       const votes::BeamEvidenceParams& params) {
  std::vector<Cell> cells;
  const PoseDeviation deviation = votes::pose_deviation(tracked.estimate, tracked.turn_rate_rad_per_s);
  for (SmallObject& object : small_objects_) {
    if (is_missed(object, look_at(object, tracked, beams, deviation, params)))
      cells.insert(cells.end(), object.cells.begin(), object.cells.end());
  }
  return cells;
}

std::vector<Cell> SmallObjects::whole(std::span<const Cell> some) const {
  std::vector<Cell> cells;
  for (const SmallObject& object : small_objects_) {
    const bool is_touched = std::any_of(some.begin(), some.end(), [&](Cell cell) {
      return std::find(object.cells.begin(), object.cells.end(), cell) != object.cells.end();
    });
    if (is_touched) cells.insert(cells.end(), object.cells.begin(), object.cells.end());
  }
  return cells;
}

bool SmallObjects::is_missed(SmallObject& object, Look look) const {
  if (look == Look::kNothing) return false;
  object.thin_looks = look == Look::kThrough ? object.thin_looks + 1 : 0;
  if (object.thin_looks < params_.thin_looks) return look == Look::kMissed;
  object.thin_looks = 0;
  return true;
}

SmallObjects::Look SmallObjects::look_at(const SmallObject& object, const TrackedScan& tracked,
                                         std::span<const votes::BeamVerdict> beams, const PoseDeviation& deviation,
                                         const votes::BeamEvidenceParams& params) const {
  const Scan& scan = tracked.scan;
  const Pose2 laser = tracked.estimate.map_from_robot * scan.robot_from_laser;
  const Point2 way = object.middle - laser.position();
  const double distance_m = way.norm();
  if (distance_m > params.most_range_m || distance_m <= object.radius_m) return Look::kNothing;
  const double bearing_rad = wrapped_angle(std::atan2(way.y(), way.x()) - laser.theta) - scan.first_bearing_rad;
  const double aside_m = object.radius_m + kBeamDeviations * deviation.aside_m(distance_m);
  const double half_rad = aside_m / distance_m;
  const double first = std::floor((bearing_rad - half_rad) / scan.bearing_step_rad);
  const double last = std::ceil((bearing_rad + half_rad) / scan.bearing_step_rad);
  if (first < 0.0 || last >= static_cast<double>(beams.size())) return Look::kNothing;
  const auto fan = beams.subspan(static_cast<std::size_t>(first), static_cast<std::size_t>(last - first) + 1);
  const double near_m = aside_m + kClearlyBeyondM;
  const auto is_beyond = [&](const votes::BeamVerdict& beam) { return beam.length_m >= distance_m + near_m; };
  const auto is_met = [&](const votes::BeamVerdict& beam) { return std::abs(beam.length_m - distance_m) < near_m; };
  if (!std::all_of(fan.begin(), fan.end(), is_beyond))
    return std::any_of(fan.begin(), fan.end(), is_met) ? Look::kMet : Look::kNothing;
  const double width = width_m(object.cells, geometry_, way / distance_m);
  if (distance_m * scan.bearing_step_rad <= params_.most_step * width) return Look::kMissed;
  const double nearest = std::round(bearing_rad / scan.bearing_step_rad);
  const double beside_m = distance_m * std::abs(bearing_rad - nearest * scan.bearing_step_rad);
  return beside_m <= 0.5 * width ? Look::kThrough : Look::kNothing;
}

}  // namespace deltamap::mapping::evidence
