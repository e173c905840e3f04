// SPDX-License-Identifier: Apache-2.0
// Where a map has changed: cells that lie together are one place.
#pragma once

#include <span>
#include <vector>

#include "core/grid/grid_patch.hpp"

namespace deltamap::tool::picture {

/// The boxes of all places, in the order of their first change. Two cells at most `reach_cells` apart in row and in
/// column belong together, and so do those that a chain of such cells joins.
[[nodiscard]] std::vector<CellBox> changed_places(std::span<const CellChange> changes, int reach_cells);

}  // namespace deltamap::tool::picture
