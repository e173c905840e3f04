// SPDX-License-Identifier: Apache-2.0
// A map that is being changed step by step, and what has changed so far: no step has to look through the whole map.
#pragma once

#include <algorithm>
#include <cstddef>
#include <vector>

#include "core/grid/grid_patch.hpp"
#include "core/grid/occupancy_grid.hpp"

namespace deltamap::mapping::redraw {

class MapDraft {
 public:
  /// `before` must outlive the draft.
  explicit MapDraft(const OccupancyGrid& before) : before_{&before}, map_{before} {}
  explicit MapDraft(OccupancyGrid&& before) = delete;

  [[nodiscard]] const OccupancyGrid& map() const { return map_; }

  void set(Cell cell, CellState state) {
    if (map_[cell] == state) return;
    map_.set(cell, state);
    touched_.push_back(map_.geometry().index_of(cell));
  }

  /// What leads from the map before to this one, in row order.
  [[nodiscard]] std::vector<CellChange> changes() const {
    std::vector<std::size_t> touched = touched_;
    std::sort(touched.begin(), touched.end());
    touched.erase(std::unique(touched.begin(), touched.end()), touched.end());
    std::vector<CellChange> changes;
    for (const std::size_t index : touched) {
      const Cell cell = map_.geometry().cell_of(index);
      if ((*before_)[cell] != map_[cell]) changes.push_back({cell, (*before_)[cell], map_[cell]});
    }
    return changes;
  }

 private:
  const OccupancyGrid* before_;
  OccupancyGrid map_;
  std::vector<std::size_t> touched_;  // cells by index; some more than once
};

}  // namespace deltamap::mapping::redraw
