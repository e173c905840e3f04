// SPDX-License-Identifier: Apache-2.0
// What a drive has written into its map, cell by cell and thing by thing, and how much of it was wrong at that moment.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "core/grid_patch.hpp"
#include "simulation/score/map_truth.hpp"

namespace deltamap::experiments {

class WrittenCells {
 public:
  explicit WrittenCells(const GridGeometry& map) : geometry_{map}, writes_(map.cell_count(), 0) {}

  /// A revision. `is_astray`: it rests on a pose that was wrong.
  void observe(std::span<const CellChange> changes, const simulation::score::MapTruth& truth, bool is_astray);
  void note_refused() { ++refused_; }

  [[nodiscard]] std::size_t revisions() const { return revisions_; }
  /// Named; writes an hour are those of the cells that have been seen.
  [[nodiscard]] std::vector<std::pair<std::string, double>> numbers(const simulation::score::CellMask& seen,
                                                                    double hours) const;

 private:
  void count_things(const std::vector<CellChange>& written, const OccupancyGrid& truth);

  GridGeometry geometry_;
  std::size_t cells_ = 0;
  std::size_t cells_astray_ = 0;
  std::size_t cells_wrong_ = 0;
  std::size_t things_ = 0;
  std::size_t things_wrong_ = 0;
  std::size_t revisions_ = 0;
  std::size_t refused_ = 0;
  std::vector<std::uint16_t> writes_;  // of each cell
};

}  // namespace deltamap::experiments
