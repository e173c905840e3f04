// SPDX-License-Identifier: Apache-2.0
// Makes the maps of one history again from the rows that can be read. A revision that is damaged follows from its
// neighbours: forward from the whole map before it, back from the one after it, for each step tells cells before and
// after. Where no whole map follows, what later steps tell of a cell is all that is known of it, and the hash of the
// next map says whether that was enough.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <vector>

#include "core/grid/grid_patch.hpp"
#include "core/grid/occupancy_grid.hpp"

namespace deltamap::mapping::store {

struct ChainStep {
  std::uint32_t number = 0;
  std::int64_t hash = 0;  ///< of M_k
  bool is_sure = false;   ///< number, hash and changes are what was written
  bool has_grid = false;  ///< M_k may be had whole
  std::vector<std::uint8_t> changes{};
};

/// One revision of the history that is made again.
struct MadeStep {
  std::uint32_t number = 0;
  std::optional<std::size_t> step{};  ///< the row that tells of it; nothing: none does
  bool is_as_it_was = true;           ///< the row's changes lead from the map before to this one
  std::vector<CellChange> changes{};  ///< that do, where the row's do not
  bool needs_grid = false;            ///< it does not follow the number before, or the row says that it is whole
  bool is_computed = false;           ///< M_k is right, and the row was damaged
  bool lacks_something = false;       ///< M_k is not right: a lost revision alone told the rest
};

struct ChainParts {
  std::vector<ChainStep> steps;  ///< by number; the first is M_0 where its row can be read
  GridGeometry geometry;
  std::function<std::optional<OccupancyGrid>(std::size_t step)> grid;  ///< whole, where it is what its hash says
  std::function<void(const MadeStep&, const OccupancyGrid&)> made;     ///< called in order
};

/// Numbers that are lost, in order: of some no more is known than that they were.
[[nodiscard]] std::vector<std::uint32_t> remake_chain(const ChainParts& parts);

}  // namespace deltamap::mapping::store
