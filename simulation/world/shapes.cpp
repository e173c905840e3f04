// SPDX-License-Identifier: Apache-2.0
#include "simulation/world/shapes.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace deltamap::simulation {
namespace {

template <typename... Cases>
struct Overloaded : Cases... {
  using Cases::operator()...;
};
template <typename... Cases>
Overloaded(Cases...) -> Overloaded<Cases...>;

constexpr double kTouch_m = 1e-6;  // closer than this counts as touching, not as overlapping

struct Interval {
  double low = std::numeric_limits<double>::infinity();
  double high = -std::numeric_limits<double>::infinity();
};

template <typename Points>
Interval shadow(const Points& points, const Point2& axis) {
  Interval interval;
  for (const Point2& point : points) {
    interval.low = std::min(interval.low, point.dot(axis));
    interval.high = std::max(interval.high, point.dot(axis));
  }
  return interval;
}

bool apart(const Interval& a, const Interval& b) { return a.high <= b.low + kTouch_m || b.high <= a.low + kTouch_m; }

std::array<Point2, 2> axes(const Box& box) {
  const double c = std::cos(box.theta_rad);
  const double s = std::sin(box.theta_rad);
  return {Point2{c, s}, Point2{-s, c}};
}

bool crosses(const Box& box, const Segment& segment) {
  const Point2 along = segment.to - segment.from;
  const std::array<Point2, 2> ends{segment.from, segment.to};
  const auto box_corners = corners(box);
  const auto box_axes = axes(box);
  const std::array<Point2, 3> separators{box_axes[0], box_axes[1], Point2{-along.y(), along.x()}.normalized()};
  return std::none_of(separators.begin(), separators.end(),
                      [&](const Point2& axis) { return apart(shadow(box_corners, axis), shadow(ends, axis)); });
}

}  // namespace

std::array<Point2, 4> corners(const Box& box) {
  const double x = 0.5 * box.width_m;
  const double y = 0.5 * box.height_m;
  const Pose2 map_from_box = box.map_from_box();
  return {map_from_box * Point2{-x, -y}, map_from_box * Point2{x, -y}, map_from_box * Point2{x, y},
          map_from_box * Point2{-x, y}};
}

std::array<Segment, 4> faces(const Box& box) {
  const auto corner = corners(box);
  return {Segment{corner[0], corner[1]}, Segment{corner[1], corner[2]}, Segment{corner[2], corner[3]},
          Segment{corner[3], corner[0]}};
}

std::vector<Segment> segments_of(const Shape& shape) {
  std::vector<Segment> segments;
  if (const auto* box = std::get_if<Box>(&shape)) {
    const auto sides = faces(*box);
    segments.assign(sides.begin(), sides.end());
  } else if (const auto* line = std::get_if<Polyline>(&shape)) {
    for (std::size_t i = 1; i < line->points.size(); ++i) segments.push_back({line->points[i - 1], line->points[i]});
  }
  return segments;
}

Box grown(const Box& box, double margin_m) {
  Box larger = box;
  larger.width_m = std::max(0.0, box.width_m + 2.0 * margin_m);
  larger.height_m = std::max(0.0, box.height_m + 2.0 * margin_m);
  return larger;
}

double distance_between(const Point2& point, const Segment& segment) {
  const Point2 along = segment.to - segment.from;
  const double length2 = along.squaredNorm();
  const double share = length2 > 0.0 ? std::clamp((point - segment.from).dot(along) / length2, 0.0, 1.0) : 0.0;
  return (point - (segment.from + share * along)).norm();
}

double distance_between(const Segment& a, const Segment& b) {
  const auto side = [](const Segment& line, const Point2& point) {
    const Point2 along = line.to - line.from;
    const Point2 offset = point - line.from;
    return along.x() * offset.y() - along.y() * offset.x();
  };
  const bool cross = side(a, b.from) * side(a, b.to) < 0.0 && side(b, a.from) * side(b, a.to) < 0.0;
  if (cross) return 0.0;
  return std::min(
      {distance_between(a.from, b), distance_between(a.to, b), distance_between(b.from, a), distance_between(b.to, a)});
}

double distance_between(const Point2& point, const Box& box) {
  const Point2 point_in_box = inverse(box.map_from_box()) * point;
  return std::hypot(std::max(0.0, std::abs(point_in_box.x()) - 0.5 * box.width_m),
                    std::max(0.0, std::abs(point_in_box.y()) - 0.5 * box.height_m));
}

double distance_between(const Point2& point, const Shape& shape) {
  if (const auto* box = std::get_if<Box>(&shape)) return distance_between(point, *box);
  if (const auto* circle = std::get_if<Circle>(&shape)) {
    return std::max(0.0, (point - circle->centre).norm() - circle->radius_m);
  }
  return distance_to_surface(point, shape);
}

double distance_to_surface(const Point2& point, const Shape& shape) {
  if (const auto* circle = std::get_if<Circle>(&shape)) {
    return std::abs((point - circle->centre).norm() - circle->radius_m);
  }
  double nearest = std::numeric_limits<double>::infinity();
  for (const Segment& segment : segments_of(shape)) nearest = std::min(nearest, distance_between(point, segment));
  return nearest;
}

bool overlap(const Box& a, const Box& b) {
  const auto a_corners = corners(a);
  const auto b_corners = corners(b);
  for (const Box* box : {&a, &b}) {
    for (const Point2& axis : axes(*box)) {
      if (apart(shadow(a_corners, axis), shadow(b_corners, axis))) return false;
    }
  }
  return true;
}

bool overlap(const Box& box, const Shape& shape) {
  return std::visit(
      Overloaded{
          [&](const Box& other) { return overlap(box, other); },
          [&](const Circle& circle) { return distance_between(circle.centre, box) + kTouch_m < circle.radius_m; },
          [&](const Polyline&) {
            const auto pieces = segments_of(shape);
            return std::any_of(pieces.begin(), pieces.end(), [&](const Segment& piece) { return crosses(box, piece); });
          }},
      shape);
}

}  // namespace deltamap::simulation
