// SPDX-License-Identifier: Apache-2.0
// Why each cell of the target asks for its source: moved the other way, the cells of a turned grid would leave holes
// between them.
#include "mapping/registration/transformed_grid.hpp"

namespace deltamap::mapping::registration {

OccupancyGrid transformed_grid(const OccupancyGrid& source, const Pose2& target_from_source,
                               const GridGeometry& target) {
  OccupancyGrid result{target};
  const Pose2 source_from_target = inverse(target_from_source);
  const double c = std::cos(source_from_target.theta);
  const double s = std::sin(source_from_target.theta);
  for (int row = 0; row < target.height; ++row) {
    for (int column = 0; column < target.width; ++column) {
      const Point2 centre = target.centre_of({column, row});
      const Point2 in_source{source_from_target.x + c * centre.x() - s * centre.y(),
                             source_from_target.y + s * centre.x() + c * centre.y()};
      result.set({column, row}, source.at(source.geometry().cell_at(in_source)));
    }
  }
  return result;
}

OccupancyGrid moved_grid(const OccupancyGrid& source, const Pose2& moved_from_source, double resolution_m) {
  const GridGeometry& g = source.geometry();
  Point2 low = moved_from_source * g.origin;
  Point2 high = low;
  for (const double x : {0.0, g.width * g.resolution_m}) {
    for (const double y : {0.0, g.height * g.resolution_m}) {
      const Point2 corner = moved_from_source * Point2{g.origin + Point2{x, y}};
      low = low.cwiseMin(corner);
      high = high.cwiseMax(corner);
    }
  }
  const auto cells = [&](double length_m) { return static_cast<int>(std::ceil(length_m / resolution_m)); };
  const Point2 origin = (low / resolution_m).array().floor() * resolution_m;
  return transformed_grid(source, moved_from_source,
                          {cells(high.x() - origin.x()), cells(high.y() - origin.y()), resolution_m, origin});
}

OccupancyGrid part_of(const OccupancyGrid& grid, double from_share, double to_share) {
  const int first = static_cast<int>(from_share * grid.width());
  const int last = static_cast<int>(to_share * grid.width());
  GridGeometry geometry = grid.geometry();
  geometry.origin.x() += first * geometry.resolution_m;
  geometry.width = last - first;
  return transformed_grid(grid, {}, geometry);
}

OccupancyGrid overridden(OccupancyGrid map, const OccupancyGrid& local) {
  assert(map.geometry() == local.geometry() && "both grids must have the same cells");
  for_each_known(local, [&](Cell cell, CellState state) { map.set(cell, state); });
  return map;
}

}  // namespace deltamap::mapping::registration
