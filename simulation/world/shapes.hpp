// SPDX-License-Identifier: Apache-2.0
// The shapes that a simulated world is made of: segments, circles and boxes in the plane of the laser, in the map
// frame.
#pragma once

#include <array>
#include <variant>
#include <vector>

#include "core/geometry/pose2.hpp"

namespace deltamap::simulation {

struct Segment {
  Point2 from{0.0, 0.0};
  Point2 to{0.0, 0.0};
};

struct Circle {
  Point2 centre{0.0, 0.0};
  double radius_m = 0.0;
};

/// A rectangle that may be turned.
struct Box {
  Point2 centre{0.0, 0.0};
  double width_m = 0.0;    ///< along its own x
  double height_m = 0.0;   ///< along its own y
  double theta_rad = 0.0;  ///< of its own x in the map

  [[nodiscard]] Pose2 map_from_box() const { return {centre.x(), centre.y(), theta_rad}; }
};

/// A chain of straight pieces.
struct Polyline {
  std::vector<Point2> points;
};

using Shape = std::variant<Polyline, Box, Circle>;

/// Counter-clockwise from the lower left corner of the box's own frame. Face i leads from corner i to corner i + 1.
[[nodiscard]] std::array<Point2, 4> corners(const Box& box);
[[nodiscard]] std::array<Segment, 4> faces(const Box& box);

/// The straight pieces of a shape; none for a circle.
[[nodiscard]] std::vector<Segment> segments_of(const Shape& shape);

/// The same box grown by a margin on every side; a negative margin shrinks it, at most to a line.
[[nodiscard]] Box grown(const Box& box, double margin_m);

[[nodiscard]] double distance_between(const Point2& point, const Segment& segment);
/// 0 where they cross.
[[nodiscard]] double distance_between(const Segment& a, const Segment& b);
/// 0 inside the box.
[[nodiscard]] double distance_between(const Point2& point, const Box& box);
/// To the shape's area (box, circle) or line (polyline); 0 inside.
[[nodiscard]] double distance_between(const Point2& point, const Shape& shape);
/// To the shape's surface, from inside as from outside.
[[nodiscard]] double distance_to_surface(const Point2& point, const Shape& shape);

/// Whether two boxes share area (touching faces do not count).
[[nodiscard]] bool overlap(const Box& a, const Box& b);
/// Whether a box shares area with a shape, or a line crosses it.
[[nodiscard]] bool overlap(const Box& box, const Shape& shape);

}  // namespace deltamap::simulation
