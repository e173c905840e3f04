// SPDX-License-Identifier: Apache-2.0
// How often beams ended in a cell and how often they passed it, over a part of the map: the raw material of a local
// map.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "core/grid/grid_patch.hpp"
#include "core/grid/occupancy_grid.hpp"
#include "mapping/redraw/placed_scan.hpp"

namespace deltamap::mapping::redraw {

struct RayCount {
  std::int32_t hits = 0;
  std::int32_t passes = 0;
  std::int32_t clear_passes = 0;  ///< of these, those that ended clearly beyond

  [[nodiscard]] int seen() const { return hits + passes; }
  [[nodiscard]] double hit_share() const { return seen() == 0 ? 0.0 : static_cast<double>(hits) / seen(); }
};

class RayCounts {
 public:
  /// `box` lies on the map.
  RayCounts(const GridGeometry& map, const CellBox& box);

  /// Nothing counts behind an occupied cell of `walls` that stops beams: one that seems to have gone through says that
  /// its pose, or the surface, is not what it seems. `stops(cell)` is asked at most once a cell; `walls` must outlive
  /// the counts. To be told before the first beam.
  void stop_at(const OccupancyGrid& walls, std::function<bool(Cell)> stops);

  /// Beams that do not come into this part are not counted. To be told before the first beam.
  void look_at(const CellBox& part) { part_ = part; }

  /// Counts the beams that have a range; those longer than `longest_m` only as passing, up to there. A pass is clear
  /// where the beam goes on for kClearlyBeyondM.
  void add(const PlacedScan& scan, double longest_m);

  [[nodiscard]] const CellBox& box() const { return box_; }
  /// `cell` must lie in the box.
  [[nodiscard]] RayCount operator[](Cell cell) const {
    const std::size_t index = box_.index_of(cell);
    return marks_[index] == kUnseen ? RayCount{} : count_at(index);
  }

  /// `visit(Cell, RayCount)` for each cell that a beam has touched, in the order in which they were.
  template <typename Visit>
  void for_each_seen(Visit&& visit) const {
    for (const std::uint32_t index : seen()) visit(cell_of(index), count_at(index));
  }
  /// The same for the cells alone that at least so many beams have passed clearly.
  template <typename Visit>
  void for_each_clear(int least_passes, Visit&& visit) const {
    for (const std::uint32_t index : seen()) {
      if (counts_[index].clear_passes >= least_passes) visit(cell_of(index));
    }
  }

 private:
  using Mark = std::uint8_t;
  static constexpr Mark kUnseen = 0, kOpen = 1, kWall = 2, kOpaque = 3;  // a wall has not been asked whether it stops
  struct Count {
    std::uint16_t hits, clear_passes, late_passes;  // a set has some 10 000 beams at most
  };

  [[nodiscard]] Cell cell_of(std::size_t index) const {
    const auto width = static_cast<std::size_t>(box_.width());
    return {box_.first.column + static_cast<int>(index % width), box_.first.row + static_cast<int>(index / width)};
  }
  /// Of a cell that has been seen.
  [[nodiscard]] RayCount count_at(std::size_t index) const {
    const Count& count = counts_[index];
    return {count.hits, count.clear_passes + count.late_passes, count.clear_passes};
  }
  [[nodiscard]] std::span<const std::uint32_t> seen() const { return {seen_.get(), seen_cells_}; }
  /// Counts of the cell begin, where it has not been seen yet.
  void see(std::size_t index) {
    if (marks_[index] != kUnseen) return;
    seen_[seen_cells_++] = static_cast<std::uint32_t>(index);
    counts_[index] = {0, 0, 0};
    const bool is_wall = walls_ != nullptr && (*walls_)[cell_of(index)] == CellState::kOccupied;
    marks_[index] = is_wall ? kWall : kOpen;
  }
  /// Does nothing count behind the cell, which has been seen?
  [[nodiscard]] bool stops(std::size_t index);
  void add_beam(const Point2& from, const Point2& end, double clear_end_m, bool hits);

  GridGeometry map_;
  CellBox box_;
  std::optional<CellBox> part_;            // that beams have to come into
  std::vector<Mark> marks_;                // by cell of the box
  std::unique_ptr<Count[]> counts_;        // by cell of the box; of no value where unseen: most cells are
  std::unique_ptr<std::uint32_t[]> seen_;  // cells by index, in the order in which they were
  std::size_t seen_cells_ = 0;
  const OccupancyGrid* walls_ = nullptr;
  std::function<bool(Cell)> stops_;
};

/// The part of the map that the scans' beams touch, up to `longest_m`; of those alone that come into `part`, if given.
[[nodiscard]] CellBox box_seen(const GridGeometry& map, std::span<const PlacedScan> scans, double longest_m,
                               const std::optional<CellBox>& part = std::nullopt);

}  // namespace deltamap::mapping::redraw
