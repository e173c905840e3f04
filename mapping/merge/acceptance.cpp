// SPDX-License-Identifier: Apache-2.0
#include "mapping/merge/acceptance.hpp"

#include "core/near_occupied.hpp"

namespace deltamap::mapping::merge {

Acceptance acceptance(const OccupancyGrid& one, const OccupancyGrid& other) {
  Acceptance counts;
  const bool same_cells = one.geometry() == other.geometry();
  for (std::size_t i = 0; i < one.cells().size(); ++i) {
    if (one.cells()[i] == CellState::kUnknown) continue;
    if (same_cells) {
      counts.add(one.cells()[i], other.cells()[i]);
    } else {
      const Point2 centre_in_map = one.geometry().centre_of(one.geometry().cell_of(i));
      counts.add(one.cells()[i], other.at(other.geometry().cell_at(centre_in_map)));
    }
  }
  return counts;
}

double surface_agreement(const OccupancyGrid& map, const OccupancyGrid& local, const Pose2& map_from_local) {
  std::size_t found = 0;
  std::size_t known = 0;
  for (std::size_t i = 0; i < local.cells().size(); ++i) {
    if (local.cells()[i] != CellState::kOccupied) continue;
    const Point2 centre_in_map = map_from_local * local.geometry().centre_of(local.geometry().cell_of(i));
    const Cell cell = map.geometry().cell_at(centre_in_map);
    const bool near = has_occupied_within(map, cell, 1);
    found += near ? 1 : 0;
    known += near || map.at(cell) != CellState::kUnknown ? 1 : 0;
  }
  return known == 0 ? 0.0 : static_cast<double>(found) / static_cast<double>(known);
}

}  // namespace deltamap::mapping::merge
