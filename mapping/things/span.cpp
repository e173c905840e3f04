// SPDX-License-Identifier: Apache-2.0
#include "mapping/things/span.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace deltamap::mapping::things {
namespace {

constexpr double kParallel_rad = 10.0 * std::numbers::pi / 180.0;

}  // namespace

Pose2 map_from_axes(const Outline& outline) { return {outline.centre.x(), outline.centre.y(), outline.heading_rad}; }

bool Span::has(const Point2& own) const {
  return own.x() >= low[0] && own.x() <= high[0] && own.y() >= low[1] && own.y() <= high[1];
}

Span span_of(const Outline& outline, const Pose2& map_from_axes) {
  constexpr double kFar = std::numeric_limits<double>::infinity();
  Span span{{kFar, kFar}, {-kFar, -kFar}};
  const Pose2 axes_from_map = inverse(map_from_axes);
  for (const Point2& corner : corners(outline)) {
    const Point2 own = axes_from_map * corner;
    span.low = {std::min(span.low[0], own.x()), std::min(span.low[1], own.y())};
    span.high = {std::max(span.high[0], own.x()), std::max(span.high[1], own.y())};
  }
  return span;
}

Outline outline_of(const Span& span, const Pose2& map_from_axes, const std::array<bool, 4>& seen) {
  Outline outline{map_from_axes * Point2{span.middle(0), span.middle(1)},
                  span.extent(0),
                  span.extent(1),
                  map_from_axes.theta,
                  seen,
                  {}};
  if (outline.length_m < outline.width_m) {
    std::swap(outline.length_m, outline.width_m);
    outline.heading_rad += std::numbers::pi / 2;
    std::rotate(outline.seen.begin(), outline.seen.begin() + 1, outline.seen.end());
  }
  outline.heading_rad = std::fmod(outline.heading_rad + 2.0 * std::numbers::pi, 2.0 * std::numbers::pi);
  if (outline.heading_rad >= std::numbers::pi) {
    outline.heading_rad -= std::numbers::pi;
    std::rotate(outline.seen.begin(), outline.seen.begin() + 2, outline.seen.end());
  }
  return outline;
}

bool are_parallel(const Outline& a, const Outline& b) {
  return std::abs(std::remainder(a.heading_rad - b.heading_rad, std::numbers::pi / 2)) <= kParallel_rad;
}

}  // namespace deltamap::mapping::things
