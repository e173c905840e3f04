// SPDX-License-Identifier: Apache-2.0
#include "mapping/merge/transformed_grid.hpp"

namespace deltamap::mapping::merge {

OccupancyGrid transformed_grid(const OccupancyGrid& source, const Pose2& target_from_source,
                               const GridGeometry& target) {
  OccupancyGrid result{target};
  const Pose2 source_from_target = inverse(target_from_source);
  for (int row = 0; row < target.height; ++row) {
    for (int column = 0; column < target.width; ++column) {
      const Cell cell{column, row};
      result.set(cell, source.at(source.geometry().cell_at(source_from_target * target.centre_of(cell))));
    }
  }
  return result;
}

OccupancyGrid overridden(OccupancyGrid map, const OccupancyGrid& local) {
  assert(map.geometry() == local.geometry() && "both grids must have the same cells");
  for (std::size_t i = 0; i < local.cells().size(); ++i) {
    if (local.cells()[i] != CellState::kUnknown) map.set(map.geometry().cell_of(i), local.cells()[i]);
  }
  return map;
}

}  // namespace deltamap::mapping::merge
