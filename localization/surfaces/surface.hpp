// SPDX-License-Identifier: Apache-2.0
// Straight pieces of the contours of a map: what a laser sees of walls, racks and containers, as lines that lie truer
// than the cells that they are drawn with.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numeric>
#include <optional>
#include <vector>

#include "core/grid/grid_patch.hpp"
#include "core/grid/occupancy_grid.hpp"

namespace deltamap::localization::surfaces {

/// Deviation of what lies anywhere within an interval, as a share of its length: 1/√12.
inline constexpr double kOfAnyPlace = 0.29;

struct Surface {
  Point2 centre{0.0, 0.0};            ///< m, map frame
  Point2 normal{0.0, 0.0};            ///< unit vector, towards free space
  double half_length_m = 0;           ///< from the centre to either end, along tangent()
  double offset_deviation_m = 0.02;   ///< of its place, by the cells that it is drawn with
  double turn_deviation_rad = 0.005;  ///< of its direction
  bool two_sided = false;             ///< free space on both sides: a panel; the normal is either one

  [[nodiscard]] Point2 tangent() const { return {-normal.y(), normal.x()}; }

  /// Where a point lies beside it.
  struct Place {
    double across_m;  ///< along the normal
    double along_m;   ///< along the tangent
    double beyond_m;  ///< past the nearer end; 0 between the ends
  };
  /// Of a point that faces the same way, map frame; nothing where the cosine between the normals is less than that.
  [[nodiscard]] std::optional<Place> place_of(const Point2& point, const Point2& faces, double least_cosine) const {
    const double cosine = normal.dot(faces);
    if ((two_sided ? std::abs(cosine) : cosine) < least_cosine) return std::nullopt;
    const double along_m = tangent().dot(point - centre);
    return Place{normal.dot(point - centre), along_m, std::max(0.0, std::abs(along_m) - half_length_m)};
  }
};

/// Pieces of one straight face, or of two that stand in line?
[[nodiscard]] bool are_one_face(const Surface& a, const Surface& b);

/// For each of `count` pieces the number of its body: those that `are_one(a, b)` holds for, joined from pair to pair.
template <typename AreOne>
[[nodiscard]] std::vector<std::size_t> bodies(std::size_t count, AreOne&& are_one) {
  std::vector<std::size_t> body(count);
  std::iota(body.begin(), body.end(), std::size_t{0});
  for (std::size_t a = 0; a < count; ++a) {
    for (std::size_t b = 0; b < a; ++b) {
      if (body[a] == body[b] || !are_one(a, b)) continue;
      std::replace(body.begin(), body.end(), std::size_t{body[a]}, std::size_t{body[b]});
    }
  }
  return body;
}

/// One face, or front and back of one thing: when it is moved both are, by as much.
[[nodiscard]] bool move_as_one(const Surface& a, const Surface& b);

/// The surfaces whose contour cells lie in the box, in a fixed order. They are cut at the box's border: what a surface
/// is depends on the map within three cells of the box alone.
[[nodiscard]] std::vector<Surface> surfaces_in(const OccupancyGrid& map, const CellBox& box);

}  // namespace deltamap::localization::surfaces
