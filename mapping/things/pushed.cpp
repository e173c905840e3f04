// SPDX-License-Identifier: Apache-2.0
#include "mapping/things/pushed.hpp"

#include <algorithm>
#include <cmath>

#include "mapping/things/span.hpp"
#include "mapping/things/surface_along.hpp"

namespace deltamap::mapping::things {
namespace {

constexpr double kMostPush_m = 1.0;
constexpr double kLeastDepth_m = 0.8;  // of a body: less is one strip beside the other
constexpr double kMostDepth_m = 3.5;
constexpr double kSameDepth_m = 0.2;   // of both strips
constexpr double kSeenOfIt = 0.5;      // of the longer strip, by the shorter one
constexpr double kBeside_m = 0.25;     // that the shorter one may reach beyond the longer
constexpr double kFloorBetween = 0.3;  // share of free cells from which on there is floor between
constexpr double kLeastPush_m = 0.15;  // less is a correction of its place
constexpr double kFrontOpen = 0.3;     // of its width, where the surface that is its front now was not seen
constexpr double kFloorBefore = 0.7;   // share of free cells before that
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

double free_share(const Span& span, const Pose2& map_from_axes, const OccupancyGrid& map) {
  int free = 0;
  for (int i = 1; i < kBetween; ++i) {
    for (int j = 1; j < kBetween; ++j) {
      const Point2 own{span.low[0] + span.extent(0) * i / kBetween, span.low[1] + span.extent(1) * j / kBetween};
      free += map.at(map.geometry().cell_at(map_from_axes * own)) == CellState::kFree ? 1 : 0;
    }
  }
  return free / static_cast<double>((kBetween - 1) * (kBetween - 1));
}

/// A surface lies across all of the way, so far along it.
bool is_front(const Span& body, std::size_t way, double at, const Pose2& map_from_axes, const OccupancyGrid& map) {
  Span line = body;
  line.low[way] = line.high[way] = at;
  const SurfaceAlong along = surface_along(map, map_from_axes * Point2{line.low[0], line.low[1]},
                                           map_from_axes * Point2{line.high[0], line.high[1]});
  return along.all - along.places <= kFrontOpen * along.all;
}

/// So far from that end of the way its front lies now.
std::optional<double> back_from_end(const Span& body, std::size_t way, double sign, const Pose2& axes,
                                    const OccupancyGrid& map) {
  const double end = sign > 0.0 ? body.high[way] : body.low[way];
  const double most_m = std::min(kMostPush_m, body.extent(way) - kLeastDepth_m);
  const auto between = [&](double from_m, double to_m) {
    Span span = body;
    span.low[way] = std::min(end - sign * from_m, end - sign * to_m);
    span.high[way] = std::max(end - sign * from_m, end - sign * to_m);
    return span;
  };
  const double cell_m = map.resolution_m();
  int first = 0;  // of the places, a cell apart, where a surface lies across
  int last = 0;
  for (int cells = 1; cells * cell_m <= most_m; ++cells) {
    const bool is_it = is_front(body, way, end - sign * cells * cell_m, axes, map);
    if (!is_it && first > 0) break;
    if (is_it && first == 0) first = cells;
    if (is_it) last = cells;
  }
  const double back_m = 0.5 * (first + last) * cell_m;
  if (back_m < kLeastPush_m || free_share(between(0.0, back_m - cell_m), axes, map) < kFloorBefore ||
      free_share(between(back_m + cell_m, body.extent(way)), axes, map) >= kFloorBetween)
    return std::nullopt;
  return back_m;
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
  if (free_share(across_longer(strips, front(strips.gone), back(strips.came)), axes, map) >= kFloorBetween)
    return std::nullopt;
  return Pushed{
      outline_of(across_longer(strips, back(strips.gone), back(strips.came)), axes, side_towards(strips.way, -onward)),
      outline_of(across_longer(strips, front(strips.gone), front(strips.came)), axes,
                 side_towards(strips.way, onward))};
}

}  // namespace

std::optional<Outline> pushed_back(const Outline& stood, const OccupancyGrid& map) {
  const Pose2 axes = map_from_axes(stood);
  const Span body = span_of(stood, axes);
  for (const std::size_t way : {0U, 1U}) {
    for (const double sign : {1.0, -1.0}) {
      const auto back_m = back_from_end(body, way, sign, axes, map);
      if (!back_m) continue;
      Span now = body;
      now.low[way] -= sign * *back_m;
      now.high[way] -= sign * *back_m;
      return outline_of(now, axes, side_towards(way, sign));
    }
  }
  return std::nullopt;
}

std::optional<Pushed> pushed_body(const Outline& came, const Outline& gone, const OccupancyGrid& map) {
  const bool may_be = (came.centre - gone.centre).norm() <= kMostDepth_m + kMostPush_m && are_parallel(came, gone);
  if (!may_be) return std::nullopt;
  const Pose2 axes = map_from_axes(came.length_m >= gone.length_m ? came : gone);
  for (const std::size_t way : {1U, 0U}) {
    auto pushed = pushed_along({span_of(came, axes), span_of(gone, axes), way}, axes, map);
    if (pushed) return pushed;
  }
  return std::nullopt;
}

}  // namespace deltamap::mapping::things
