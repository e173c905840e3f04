// SPDX-License-Identifier: Apache-2.0
// Polygons of the plane, as people draw bays and zones: which point lies inside, whether the sides cross, and how much
// two have in common. Corners in order, either way round, without repeating the first; metres.
#pragma once

#include <optional>
#include <utility>
#include <vector>

#include "core/geometry/pose2.hpp"

namespace deltamap {

using Polygon = std::vector<Point2>;

struct PolygonBox {
  Point2 low{0.0, 0.0};
  Point2 high{0.0, 0.0};

  [[nodiscard]] bool meets(const PolygonBox& other) const {
    return (low.array() < other.high.array()).all() && (other.low.array() < high.array()).all();
  }
};

/// Of at least one corner.
[[nodiscard]] PolygonBox bounding_box(const Polygon& polygon);
/// m², >= 0; of no meaning where its sides cross.
[[nodiscard]] double area_m2(const Polygon& polygon);
/// A point on a side may count as inside or outside.
[[nodiscard]] bool contains(const Polygon& polygon, const Point2& point);
/// The first two sides that cross or touch though they are no neighbours, or two neighbours that lie on each other; a
/// side is named after its first corner, from 0. Nothing: the polygon is simple.
[[nodiscard]] std::optional<std::pair<std::size_t, std::size_t>> crossing_sides(const Polygon& polygon);
/// Area that both cover, m², by samples that lie at most `step_m` apart.
[[nodiscard]] double shared_area_m2(const Polygon& a, const Polygon& b, double step_m);

}  // namespace deltamap
