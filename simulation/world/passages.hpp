// SPDX-License-Identifier: Apache-2.0
// Which floor can be reached by something round of a given size: tells whether corridors are still passable and from
// which side a container can be seen and lifted.
#pragma once

#include <vector>

#include "core/grid/occupancy_grid.hpp"
#include "simulation/world/world.hpp"

namespace deltamap::simulation {

/// Floor in cells of 0.2 m.
struct ReachableFloor {
  GridGeometry geometry;
  std::vector<bool> reached;  ///< a cell each

  [[nodiscard]] bool contains(const Point2& point) const;
};

/// All floor that keeps clearance_m from every surface and is joined to the neighbourhood of `from`.
[[nodiscard]] ReachableFloor reachable_floor(const World& world, const Point2& from, double clearance_m);

/// The share of `floor` that is also reached in `other` (of the same geometry); 1 for no floor.
[[nodiscard]] double share_still_reached(const ReachableFloor& floor, const ReachableFloor& other);

}  // namespace deltamap::simulation
