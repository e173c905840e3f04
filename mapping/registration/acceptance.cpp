// SPDX-License-Identifier: Apache-2.0
#include "mapping/registration/acceptance.hpp"

#include "core/grid/near_occupied.hpp"

namespace deltamap::mapping::registration {

Acceptance acceptance(const OccupancyGrid& one, const OccupancyGrid& other) {
  Acceptance counts;
  const bool same_cells = one.geometry() == other.geometry();
  for_each_known(one, [&](Cell cell, CellState state) {
    counts.add(state, other.at(same_cells ? cell : other.geometry().cell_at(one.geometry().centre_of(cell))));
  });
  return counts;
}

double surface_agreement(const OccupancyGrid& map, const OccupancyGrid& local, const Pose2& map_from_local) {
  std::size_t found = 0;
  std::size_t known = 0;
  for_each_known(local, [&](Cell local_cell, CellState state) {
    if (state != CellState::kOccupied) return;
    const Cell cell = map.geometry().cell_at(map_from_local * local.geometry().centre_of(local_cell));
    const bool near = has_occupied_within(map, cell, 1);
    found += near ? 1 : 0;
    known += near || map.at(cell) != CellState::kUnknown ? 1 : 0;
  });
  return known == 0 ? 0.0 : static_cast<double>(found) / static_cast<double>(known);
}

}  // namespace deltamap::mapping::registration
