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

class BoxWalk;

class RayCounts {
 public:
  RayCounts(const GridGeometry& map, const CellBox& box);

  /// Nothing counts behind an occupied cell of `walls` that stops beams: one that seems to have gone through says that
  /// its pose, or the surface, is not what it seems. `stops(cell)` is asked once a cell.
  void stop_at(const OccupancyGrid& walls, std::function<bool(Cell)> stops);

  /// Counts the beams that have a range; those longer than `longest_m` only as passing, up to there. A pass is clear
  /// where the beam goes on for `clear_m`. Beams that begin outside the box count for nothing.
  void add(const PlacedScan& scan, double longest_m, double clear_m);

  [[nodiscard]] const CellBox& box() const { return box_; }
  /// `cell` must lie in the box.
  [[nodiscard]] const RayCount& operator[](Cell cell) const { return counts_[index_of(cell)]; }
  /// Occupied where the share of hits is at least `least_hit_share`, else free; unknown where nothing was seen.
  [[nodiscard]] OccupancyGrid local_map(double least_hit_share) const;

 private:
  [[nodiscard]] std::size_t index_of(Cell cell) const {
    return static_cast<std::size_t>(cell.row - box_.first.row) * static_cast<std::size_t>(box_.width()) +
           static_cast<std::size_t>(cell.column - box_.first.column);
  }

  /// Counts the walk's passes; false where it is stopped or leaves the box.
  [[nodiscard]] bool passes_to_end(BoxWalk& walk, double clear_end_m);
  [[nodiscard]] bool stops_in(std::size_t index);

  GridGeometry map_;
  CellBox box_;
  std::vector<RayCount> counts_;
  std::vector<CellState> walls_;         // occupied: stops, or is to be asked
  std::vector<std::uint8_t> is_opaque_;  // has been asked, and stops
  std::function<bool(Cell)> stops_;
};

/// The part of the map that the scans' beams touch, up to `longest_m`.
[[nodiscard]] CellBox box_seen(const GridGeometry& map, std::span<const PlacedScan> scans, double longest_m);

}  // namespace deltamap::mapping
