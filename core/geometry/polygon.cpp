// SPDX-License-Identifier: Apache-2.0
#include "core/geometry/polygon.hpp"

#include <algorithm>
#include <cmath>

namespace deltamap {
namespace {

double turn(const Point2& a, const Point2& b, const Point2& c) {
  return (b.x() - a.x()) * (c.y() - a.y()) - (b.y() - a.y()) * (c.x() - a.x());
}

bool lies_between(const Point2& a, const Point2& b, const Point2& on_line) {
  return (on_line.array() >= a.cwiseMin(b).array()).all() && (on_line.array() <= a.cwiseMax(b).array()).all();
}

/// Touching counts.
bool do_cross(const Point2& a, const Point2& b, const Point2& c, const Point2& d) {
  const double c_turn = turn(a, b, c);
  const double d_turn = turn(a, b, d);
  const double a_turn = turn(c, d, a);
  const double b_turn = turn(c, d, b);
  if (c_turn * d_turn < 0.0 && a_turn * b_turn < 0.0) return true;
  return (c_turn == 0.0 && lies_between(a, b, c)) || (d_turn == 0.0 && lies_between(a, b, d)) ||
         (a_turn == 0.0 && lies_between(c, d, a)) || (b_turn == 0.0 && lies_between(c, d, b));
}

/// The side from b on runs back along that from a to b.
bool folds_back(const Point2& a, const Point2& b, const Point2& c) {
  return turn(a, b, c) == 0.0 && (a - b).dot(c - b) >= 0.0;
}

}  // namespace

PolygonBox bounding_box(const Polygon& polygon) {
  PolygonBox box{polygon.front(), polygon.front()};
  for (const Point2& corner : polygon) box = {box.low.cwiseMin(corner), box.high.cwiseMax(corner)};
  return box;
}

double area_m2(const Polygon& polygon) {
  double twice = 0.0;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const Point2& from = polygon[i];
    const Point2& to = polygon[(i + 1) % polygon.size()];
    twice += from.x() * to.y() - to.x() * from.y();
  }
  return 0.5 * std::abs(twice);
}

bool contains(const Polygon& polygon, const Point2& point) {
  bool is_inside = false;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const Point2& a = polygon[i];
    const Point2& b = polygon[(i + 1) % polygon.size()];
    if ((a.y() > point.y()) == (b.y() > point.y())) continue;
    const double x = a.x() + (point.y() - a.y()) / (b.y() - a.y()) * (b.x() - a.x());
    if (point.x() < x) is_inside = !is_inside;
  }
  return is_inside;
}

std::optional<std::pair<std::size_t, std::size_t>> crossing_sides(const Polygon& polygon) {
  const std::size_t count = polygon.size();
  const auto corner = [&](std::size_t i) -> const Point2& { return polygon[i % count]; };
  for (std::size_t i = 0; i < count; ++i) {
    if (folds_back(corner(i), corner(i + 1), corner(i + 2))) return std::pair{i, (i + 1) % count};
    for (std::size_t j = i + 2; j < count; ++j) {
      const bool are_neighbours = i == 0 && j == count - 1;
      if (!are_neighbours && do_cross(corner(i), corner(i + 1), corner(j), corner(j + 1))) return std::pair{i, j};
    }
  }
  return std::nullopt;
}

double shared_area_m2(const Polygon& a, const Polygon& b, double step_m) {
  const PolygonBox of_a = bounding_box(a);
  const PolygonBox of_b = bounding_box(b);
  if (!of_a.meets(of_b)) return 0.0;
  const Point2 low = of_a.low.cwiseMax(of_b.low);
  const Point2 size = of_a.high.cwiseMin(of_b.high) - low;
  const int columns = static_cast<int>(std::ceil(size.x() / step_m));
  const int rows = static_cast<int>(std::ceil(size.y() / step_m));
  const Point2 step{size.x() / columns, size.y() / rows};
  int both = 0;
  for (int row = 0; row < rows; ++row) {
    for (int column = 0; column < columns; ++column) {
      const Point2 middle = low + Point2{(column + 0.5) * step.x(), (row + 0.5) * step.y()};
      if (contains(a, middle) && contains(b, middle)) ++both;
    }
  }
  return both * step.x() * step.y();
}

}  // namespace deltamap
