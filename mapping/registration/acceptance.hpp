// SPDX-License-Identifier: Apache-2.0
// The acceptance index w of two maps (paper Eq. 11). It counts only where both know; a merge that hardly overlaps can
// score 1, so that it never decides alone: surface_agreement() says how much of the contour was found again.
#pragma once

#include <cstddef>

#include "core/grid/occupancy_grid.hpp"

namespace deltamap::mapping::registration {

struct Acceptance {
  std::size_t agreeing = 0;     ///< agr: cells that are free in both or occupied in both
  std::size_t disagreeing = 0;  ///< dis: cells that are free in one and occupied in the other

  /// Counts a cell of the two maps.
  void add(CellState one, CellState other) {
    if (one == CellState::kUnknown || other == CellState::kUnknown) return;
    ++(one == other ? agreeing : disagreeing);
  }
  /// w = agr / (agr + dis), 0 where nothing agrees.
  [[nodiscard]] double value() const {
    return agreeing == 0 ? 0.0 : static_cast<double>(agreeing) / static_cast<double>(agreeing + disagreeing);
  }
};

/// Eq. 11 over the cells of `one`; `other` is read at their centres where its geometry differs.
[[nodiscard]] Acceptance acceptance(const OccupancyGrid& one, const OccupancyGrid& other);

/// Share of the occupied cells of `local` that fall on or beside (8 neighbours) an occupied cell of `map`, of those
/// that fall on known cells. 0 where none does.
[[nodiscard]] double surface_agreement(const OccupancyGrid& map, const OccupancyGrid& local,
                                       const Pose2& map_from_local);

}  // namespace deltamap::mapping::registration
