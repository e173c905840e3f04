// SPDX-License-Identifier: Apache-2.0
// What a drive has written into its map, cell by cell and thing by thing, and how much of it was wrong at that moment.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "core/grid/grid_patch.hpp"
#include "simulation/score/map_truth.hpp"

namespace deltamap::experiments {

class WrittenCells {
 public:
  explicit WrittenCells(const GridGeometry& map) : geometry_{map}, writes_(map.cell_count(), 0) {}

  struct Written {
    std::span<const CellChange> changes;
    const OccupancyGrid& map;  ///< that they have led to
    bool is_astray = false;    ///< it rests on a pose that was wrong
  };
  /// A revision that draws. `standing`: all that stands now, passing things too.
  void observe(const Written& written, const simulation::score::MapTruth& truth, const OccupancyGrid& standing);
  /// A revision that takes back what others have drawn: nothing new is said of the world.
  void observe_withdrawal(std::span<const CellChange> changes);
  void note_refused() { ++refused_; }

  [[nodiscard]] std::size_t revisions() const { return revisions_; }
  /// Named; writes an hour are those of the cells that have been seen.
  [[nodiscard]] std::vector<std::pair<std::string, double>> numbers(const simulation::score::CellMask& seen,
                                                                    double hours) const;

 private:
  template <typename IsRight>
  void count_things(const std::vector<CellChange>& written, IsRight&& is_right);

  GridGeometry geometry_;
  std::size_t cells_ = 0;
  std::size_t cells_astray_ = 0;
  std::size_t cells_withdrawn_ = 0;
  std::size_t cells_wrong_ = 0;
  std::size_t things_ = 0;
  std::size_t things_wrong_ = 0;
  std::size_t revisions_ = 0;
  std::size_t refused_ = 0;
  std::vector<std::uint16_t> writes_;  // of each cell
};

}  // namespace deltamap::experiments
