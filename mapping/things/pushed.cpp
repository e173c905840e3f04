// SPDX-License-Identifier: Apache-2.0
#include "mapping/things/pushed.hpp"

#include <algorithm>
#include <cmath>

#include "mapping/things/span.hpp"

namespace deltamap::mapping::things {
namespace {

constexpr double kMostPush_m = 1.0;
constexpr double kLeastDepth_m = 0.8;  // of a body: less is one strip beside the other
constexpr double kMostDepth_m = 3.5;
constexpr double kSameDepth_m = 0.2;   // of both strips
constexpr double kSeenOfIt = 0.5;      // of the longer strip, by the shorter one
constexpr double kBeside_m = 0.25;     // that the shorter one may reach beyond the longer
constexpr double kFloorBetween = 0.3;  // share of free cells from which on there is floor between
constexpr int kBetween = 12;           // samples along and across

/// Two strips across the way of the push, in common axes.
struct Strips {
  Span came;
  Span gone;
  std::size_t way;  // the axis of the push

  [[nodiscard]] std::size_t across() const { return 1 - way; }
  [[nodiscard]] const Span& longer() const { return came.extent(across()) >= gone.extent(across()) ? came : gone; }
  [[nodiscard]] const Span& shorter() const { return &longer() == &came ? gone : came; }
  [[nodiscard]] double onward() const { return came.middle(way) > gone.middle(way) ? 1.0 : -1.0; }
};

/// As deep as each other, a body's depth apart, the longer one no less than twice as long as deep.
bool are_opposite(const Strips& strips) {
  const double came_m = strips.came.extent(strips.way);
  const double gone_m = strips.gone.extent(strips.way);
  const double depth_m = std::abs(strips.came.middle(strips.way) - strips.gone.middle(strips.way));
  return std::max(came_m, gone_m) <= kMostPush_m && std::abs(came_m - gone_m) <= kSameDepth_m &&
         depth_m >= kLeastDepth_m && depth_m <= kMostDepth_m &&
         2.0 * strips.longer().extent(strips.way) <= strips.longer().extent(strips.across());
}

/// The shorter one lies beside the longer, as far as it was seen; of a face that is seen from the side nothing more
/// can be.
bool are_beside(const Strips& strips) {
  const std::size_t across = strips.across();
  const Span& longer = strips.longer();
  const Span& shorter = strips.shorter();
  const bool is_face = shorter.extent(across) < kOneFace_m;
  return (is_face || shorter.extent(across) >= kSeenOfIt * longer.extent(across)) &&
         shorter.low[across] >= longer.low[across] - kBeside_m &&
         shorter.high[across] <= longer.high[across] + kBeside_m;
}

/// Across the longer one, along the way from one place to the other.
Span across_longer(const Strips& strips, double from, double to) {
  Span span = strips.longer();
  span.low[strips.way] = std::min(from, to);
  span.high[strips.way] = std::max(from, to);
  return span;
}

bool is_floor(const Span& span, const Pose2& map_from_axes, const OccupancyGrid& map) {
  int free = 0;
  for (int i = 1; i < kBetween; ++i) {
    for (int j = 1; j < kBetween; ++j) {
      const Point2 own{span.low[0] + span.extent(0) * i / kBetween, span.low[1] + span.extent(1) * j / kBetween};
      free += map.at(map.geometry().cell_at(map_from_axes * own)) == CellState::kFree ? 1 : 0;
    }
  }
  return free >= kFloorBetween * (kBetween - 1) * (kBetween - 1);
}

/// The side that faces along the way, or against it.
std::array<bool, 4> side_towards(std::size_t way, double sign) {
  std::array<bool, 4> seen{};
  seen[way + (sign > 0.0 ? 0 : 2)] = true;
  return seen;
}

std::optional<Pushed> pushed_along(const Strips& strips, const Pose2& axes, const OccupancyGrid& map) {
  if (!are_opposite(strips) || !are_beside(strips)) return std::nullopt;
  const double onward = strips.onward();
  const auto front = [&](const Span& span) { return onward > 0.0 ? span.high[strips.way] : span.low[strips.way]; };
  const auto back = [&](const Span& span) { return onward > 0.0 ? span.low[strips.way] : span.high[strips.way]; };
  if (is_floor(across_longer(strips, front(strips.gone), back(strips.came)), axes, map)) return std::nullopt;
  return Pushed{
      outline_of(across_longer(strips, back(strips.gone), back(strips.came)), axes, side_towards(strips.way, -onward)),
      outline_of(across_longer(strips, front(strips.gone), front(strips.came)), axes,
                 side_towards(strips.way, onward))};
}

}  // namespace

std::optional<Pushed> pushed_body(const Outline& came, const Outline& gone, const OccupancyGrid& map) {
  const bool may_be = (came.centre - gone.centre).norm() <= kMostDepth_m + kMostPush_m && are_parallel(came, gone);
  if (!may_be) return std::nullopt;
  const Pose2 axes = map_from_axes(came.length_m >= gone.length_m ? came : gone);
  for (const std::size_t way : {1U, 0U}) {
    const auto pushed = pushed_along({span_of(came, axes), span_of(gone, axes), way}, axes, map);
    if (pushed) return pushed;
  }
  return std::nullopt;
}

}  // namespace deltamap::mapping::things
