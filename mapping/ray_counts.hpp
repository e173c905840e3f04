// SPDX-License-Identifier: Apache-2.0
// How often beams ended in a cell and how often they passed it, over a part of the map: the raw material of a local
// map.
#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "core/grid_patch.hpp"
#include "core/messages.hpp"
#include "core/occupancy_grid.hpp"

namespace deltamap::mapping {

/// A scan and the pose that it is drawn from.
struct PlacedScan {
  const TrackedScan* tracked = nullptr;
  Pose2 map_from_robot;
};

struct RayCount {
  std::uint16_t hits = 0;
  std::uint16_t passes = 0;
  std::uint16_t clear_passes = 0;  ///< of these, those that ended clearly beyond

  [[nodiscard]] int seen() const { return hits + passes; }
  [[nodiscard]] double hit_share() const { return seen() == 0 ? 0.0 : static_cast<double>(hits) / seen(); }
};

class RayCounts {
 public:
  RayCounts(const GridGeometry& map, const CellBox& box);

  /// Nothing counts behind an occupied cell of `walls` that stops beams: one that seems to have gone through says that
  /// its pose, or the surface, is not what it seems. `stops(cell)` is asked once a cell; `walls` must outlive the
  /// counts.
  void stop_at(const OccupancyGrid& walls, std::function<bool(Cell)> stops);

  /// Counts the beams that have a range; those longer than `longest_m` only as passing, up to there. A pass is clear
  /// where the beam goes on for `clear_m`.
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

  GridGeometry map_;
  CellBox box_;
  std::vector<RayCount> counts_;
  enum class Opaque : std::uint8_t { kUnasked, kYes, kNo };
  [[nodiscard]] bool stops_in(Cell cell);

  const OccupancyGrid* walls_ = nullptr;
  std::function<bool(Cell)> stops_;
  std::vector<Opaque> opaque_;
};

/// The part of the map that the scans' beams touch, up to `longest_m`.
[[nodiscard]] CellBox box_seen(const GridGeometry& map, std::span<const PlacedScan> scans, double longest_m);

}  // namespace deltamap::mapping
