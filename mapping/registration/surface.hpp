// SPDX-License-Identifier: Apache-2.0
// Surfaces as points with normals, and the nearest of them to a place: what scans are matched against. Made from a
// scan's ordered ray ends or from a map's contour (occupied cells beside a free one).
#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "core/geometry/pose2.hpp"
#include "core/grid/grid_patch.hpp"
#include "core/grid/occupancy_grid.hpp"
#include "core/messages.hpp"

namespace deltamap::mapping::registration {

struct SurfacePoint {
  Point2 position;
  Point2 normal;  ///< unit length, either side
};

/// Where the beams with a valid range of at most `longest_m` ended, in the robot's frame, in order of bearing.
[[nodiscard]] std::vector<Point2> ray_ends(const TrackedScan& tracked, double longest_m);

/// Of the surface that each of the ends lies on with its neighbours in the sweep, unit length; zero where it lies on
/// none.
[[nodiscard]] std::vector<Eigen::Vector2f> normals_of(std::span<const Point2> ordered_ends);

/// The ends that lie on a line with their neighbours in the sweep; the others are left out.
[[nodiscard]] std::vector<SurfacePoint> surface_of(std::span<const Point2> ordered_ends);

/// The contour of a map inside a box: centres of occupied cells that have a free neighbour and lie on a line with
/// others.
[[nodiscard]] std::vector<SurfacePoint> contour_of(const OccupancyGrid& map, const CellBox& box);
/// Of these, the points of cells that are wanted: what is not costs next to nothing.
[[nodiscard]] std::vector<SurfacePoint> contour_of(const OccupancyGrid& map, const CellBox& box,
                                                   const std::function<bool(Cell)>& is_wanted);

/// A table over the plane that answers the nearest surface point in constant time.
class NearestSurface {
 public:
  /// Places farther than `reach_m` from every point have no answer; `table_cell_m` is how finely places are told apart.
  NearestSurface(std::vector<SurfacePoint> points, double table_cell_m, double reach_m);

  /// Null where there is none in reach. The answer is exact up to half a table cell.
  [[nodiscard]] const SurfacePoint* nearest(const Point2& place) const {
    const Point2 in_table = (place - table_.origin) / table_.resolution_m;
    // Before the cast, which tells nothing of a place beyond all integers; and then truncation is rounding down.
    if (!(in_table.x() >= 0.0 && in_table.y() >= 0.0 && in_table.x() < table_.width && in_table.y() < table_.height)) {
      return nullptr;
    }
    const Cell cell{static_cast<int>(in_table.x()), static_cast<int>(in_table.y())};
    const std::int32_t index = nearest_[table_.index_of(cell)];
    return index < 0 ? nullptr : &points_[static_cast<std::size_t>(index)];
  }
  /// Square of the distance to the nearest point, m², from the middle of the table cell that holds the place; the
  /// reach's where none is in reach.
  [[nodiscard]] float rough_distance2(float x, float y) const {
    const auto column = static_cast<std::int32_t>((x - low_x_) * cells_per_metre_);
    const auto row = static_cast<std::int32_t>((y - low_y_) * cells_per_metre_);
    // The table has a margin of the reach: what truncation puts into its first row or column is far from any point.
    if (static_cast<std::uint32_t>(column) >= static_cast<std::uint32_t>(table_.width) ||
        static_cast<std::uint32_t>(row) >= static_cast<std::uint32_t>(table_.height)) {
      return reach2_;
    }
    return distance2_[static_cast<std::size_t>(row) * static_cast<std::size_t>(table_.width) +
                      static_cast<std::size_t>(column)];
  }

 private:
  std::vector<SurfacePoint> points_;
  GridGeometry table_;
  std::vector<std::int32_t> nearest_;  // index into points_, -1 = none in reach
  std::vector<float> distance2_;       // m², from the cell's middle; the reach's where none is in reach
  float reach2_ = 0.0F;
  float cells_per_metre_ = 1.0F;
  float low_x_ = 0.0F;
  float low_y_ = 0.0F;
};

}  // namespace deltamap::mapping::registration
