// SPDX-License-Identifier: Apache-2.0
// Contour F1 of two maps: occupied cells paired one to one, equal cells first, then with a neighbour (tolerance 1
// cell). Each cell pairs once, so that thick and thin walls cost; unlike Eq. 11 it does not reward free space.
#pragma once

#include <cstddef>

#include "core/grid/occupancy_grid.hpp"

namespace deltamap::mapping::registration {

struct ContourScore {
  std::size_t paired = 0;  ///< occupied cells of one with a partner in the other
  std::size_t occupied_one = 0;
  std::size_t occupied_other = 0;  ///< of these, only those where `one` is known or that found a partner

  [[nodiscard]] double recall() const;     ///< of one's contour
  [[nodiscard]] double precision() const;  ///< of the other's
  [[nodiscard]] double f1() const;
};

/// `one` is the reference: the other's occupied cells where it knows nothing count only where they pair. `other` is
/// read at the centres of one's cells where its geometry differs.
[[nodiscard]] ContourScore contour_score(const OccupancyGrid& one, const OccupancyGrid& other);

}  // namespace deltamap::mapping::registration
