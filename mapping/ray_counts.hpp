// SPDX-License-Identifier: Apache-2.0
// How often beams ended in a cell and how often they passed it, over a part of the map: the raw material of a local
// map.
#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "core/grid_patch.hpp"
#include "core/occupancy_grid.hpp"
#include "mapping/placed_scan.hpp"

namespace deltamap::mapping {

struct RayCount {
  std::int32_t hits = 0;
  std::int32_t passes = 0;
  std::int32_t clear_passes = 0;  ///< of these, those that ended clearly beyond

  [[nodiscard]] int seen() const { return hits + passes; }
  [[nodiscard]] double hit_share() const { return seen() == 0 ? 0.0 : static_cast<double>(hits) / seen(); }
};

class RayCounts {
 public:
  RayCounts(const GridGeometry& map, const CellBox& box);

  /// Nothing counts behind an occupied cell of `walls` that stops beams: one that seems to have gone through says that
  /// its pose, or the surface, is not what it seems. `stops(cell)` is asked at most once a cell; `walls` must outlive
  /// the counts. To be told before the first beam.
  void stop_at(const OccupancyGrid& walls, std::function<bool(Cell)> stops);

  /// Counts the beams that have a range; those longer than `longest_m` only as passing, up to there. A pass is clear
  /// where the beam goes on for `clear_m`. Beams that begin outside the box count for nothing.
  void add(const PlacedScan& scan, double longest_m, double clear_m);

  [[nodiscard]] const CellBox& box() const { return box_; }
  /// `cell` must lie in the box.
  [[nodiscard]] RayCount operator[](Cell cell) const { return count_at(index_of(cell)); }

  /// `visit(Cell, RayCount)` for each cell that a beam has touched, in the order in which they were.
  template <typename Visit>
  void for_each_seen(Visit&& visit) const {
    for (const std::uint32_t index : seen_) visit(cell_of(index), count_at(index));
  }

 private:
  enum class Mark : std::uint8_t { kUnseen, kOpen, kWall, kOpaque };  // a wall has not been asked yet

  [[nodiscard]] std::size_t index_of(Cell cell) const {
    return static_cast<std::size_t>(cell.row - box_.first.row) * static_cast<std::size_t>(box_.width()) +
           static_cast<std::size_t>(cell.column - box_.first.column);
  }
  [[nodiscard]] Cell cell_of(std::size_t index) const {
    const auto width = static_cast<std::size_t>(box_.width());
    return {box_.first.column + static_cast<int>(index % width), box_.first.row + static_cast<int>(index / width)};
  }
  [[nodiscard]] RayCount count_at(std::size_t index) const {
    return {hits_[index], clear_passes_[index] + late_passes_[index], clear_passes_[index]};
  }
  /// A cell is touched for the first time.
  Mark first_seen(std::size_t index);
  [[nodiscard]] bool stops_in(std::size_t index);
  void add_beam(const Point2& from, const Point2& end, double clear_end_m, bool hits);

  GridGeometry map_;
  CellBox box_;
  // By cell of the box. Apart from each other, for most of them are never touched but to be set to 0.
  std::vector<Mark> marks_;
  std::vector<std::int32_t> hits_;
  std::vector<std::int32_t> clear_passes_;
  std::vector<std::int32_t> late_passes_;
  std::vector<std::uint32_t> seen_;
  const OccupancyGrid* walls_ = nullptr;
  std::function<bool(Cell)> stops_;
};

/// The part of the map that the scans' beams touch, up to `longest_m`.
[[nodiscard]] CellBox box_seen(const GridGeometry& map, std::span<const PlacedScan> scans, double longest_m);

}  // namespace deltamap::mapping
