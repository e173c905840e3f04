// SPDX-License-Identifier: Apache-2.0
// Cells that an operator has set. Scans taken before the order never write them again, nor do scans taken for a while
// after it: who takes a change back does not want it back a second later. Later evidence that lasts may write them.
#pragma once

#include <cstdint>
#include <deque>
#include <span>
#include <vector>

#include "core/grid/grid_patch.hpp"
#include "core/grid/tiled.hpp"
#include "core/messages.hpp"

namespace deltamap::mapping::gate {

struct OperatorCellsParams {
  double hold_s;     ///< of scans after the operator's word; >= 0 (mapping.persistence_s)
  int margin_cells;  ///< as far as a second look may draw a face beside where it stood; >= 0
};

class OperatorCells {
 public:
  explicit OperatorCells(const OperatorCellsParams& params) : params_{params} {}

  /// The operator has set these cells of a map before the scan of that time.
  void hold(const GridGeometry& map, std::span<const CellChange> cells, Timestamp time);

  /// `changes` without those of cells that are held against this set.
  [[nodiscard]] std::vector<CellChange> allowed(std::vector<CellChange> changes, const ScanSet& set) const;

 private:
  struct Held {
    Timestamp time;
    Tiled<std::uint8_t> cells;  // 1: held
  };

  OperatorCellsParams params_;
  std::deque<Held> held_;  // oldest first
};

}  // namespace deltamap::mapping::gate
