// SPDX-License-Identifier: Apache-2.0
// How far an outline reaches along the axes of another: ends of bodies that stand parallel are compared so.
#pragma once

#include <array>
#include <cstddef>

#include "core/geometry/pose2.hpp"
#include "mapping/things/thing.hpp"

namespace deltamap::mapping::things {

/// The frame of an outline: x along its length.
[[nodiscard]] Pose2 map_from_axes(const Outline& outline);

/// From low to high along both axes, m.
struct Span {
  std::array<double, 2> low{};
  std::array<double, 2> high{};

  [[nodiscard]] double extent(std::size_t axis) const { return high[axis] - low[axis]; }
  [[nodiscard]] double middle(std::size_t axis) const { return 0.5 * (high[axis] + low[axis]); }
  [[nodiscard]] bool has(const Point2& own) const;
};

/// Around the outline, in those axes.
[[nodiscard]] Span span_of(const Outline& outline, const Pose2& map_from_axes);

/// The same place as an outline whose sides `seen` are numbered from +x on, counter-clockwise.
[[nodiscard]] Outline outline_of(const Span& span, const Pose2& map_from_axes, const std::array<bool, 4>& seen);

/// Their sides are parallel, whichever is the longer one.
[[nodiscard]] bool are_parallel(const Outline& a, const Outline& b);

}  // namespace deltamap::mapping::things
