// SPDX-License-Identifier: Apache-2.0
// Changed cells that lie together: what one revision has to say of one place.
#pragma once

#include <span>
#include <vector>

#include "core/grid/grid_patch.hpp"

namespace deltamap::mapping::things {

/// In the order of their first change. Two cells at most `reach_cells` apart in row and in column belong together, and
/// so do those that a chain of such cells joins.
[[nodiscard]] std::vector<std::vector<CellChange>> cell_clusters(std::span<const CellChange> changes, int reach_cells);

}  // namespace deltamap::mapping::things
