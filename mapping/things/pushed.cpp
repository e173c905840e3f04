// SPDX-License-Identifier: Apache-2.0
#include "mapping/things/pushed.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace deltamap::mapping::things {
namespace {

constexpr double kMostPush_m = 1.0;
constexpr double kLeastDepth_m = 0.8;  // of a body: less is one strip beside the other
constexpr double kMostDepth_m = 3.5;
constexpr double kSameDepth_m = 0.2;  // of both strips
constexpr double kSeenOfIt = 0.5;     // of the longer strip, by the shorter one
constexpr double kBeside_m = 0.25;    // that the shorter one may reach beyond the longer
constexpr double kSameHeading_rad = 10.0 * std::numbers::pi / 180.0;
constexpr double kFloorBetween = 0.3;  // share of free cells from which on there is floor between
constexpr int kBetween = 12;           // samples along and across

bool is_strip(const Outline& outline) {
  return outline.width_m <= kMostPush_m && 2.0 * outline.width_m <= outline.length_m;
}

bool are_parallel(const Outline& a, const Outline& b) {
  return std::abs(std::sin(a.heading_rad - b.heading_rad)) <= std::sin(kSameHeading_rad);
}

/// In the frame of the longer strip: along it, from one y to the other.
bool is_floor(const Outline& longer, double from_y, double to_y, const OccupancyGrid& map) {
  const Pose2 map_from_strip{longer.centre.x(), longer.centre.y(), longer.heading_rad};
  int free = 0;
  for (int i = 1; i < kBetween; ++i) {
    for (int j = 1; j < kBetween; ++j) {
      const Point2 own{(static_cast<double>(i) / kBetween - 0.5) * longer.length_m,
                       from_y + (to_y - from_y) * j / kBetween};
      free += map.at(map.geometry().cell_at(map_from_strip * own)) == CellState::kFree ? 1 : 0;
    }
  }
  return free >= kFloorBetween * (kBetween - 1) * (kBetween - 1);
}

/// Along the longer strip, across from one y to the other, of which the second is where it was seen.
Outline across(const Outline& longer, double from_y, double to_y) {
  const Pose2 map_from_strip{longer.centre.x(), longer.centre.y(), longer.heading_rad};
  Outline outline;
  outline.centre = map_from_strip * Point2{0.0, 0.5 * (from_y + to_y)};
  outline.length_m = longer.length_m;
  outline.width_m = std::abs(to_y - from_y);
  outline.heading_rad = longer.heading_rad;
  std::size_t seen = to_y > from_y ? 1 : 3;
  if (outline.length_m < outline.width_m) {
    std::swap(outline.length_m, outline.width_m);
    const double turned_rad = outline.heading_rad + std::numbers::pi / 2;
    seen = turned_rad < std::numbers::pi ? (seen + 3) % 4 : (seen + 1) % 4;
    outline.heading_rad = turned_rad < std::numbers::pi ? turned_rad : turned_rad - std::numbers::pi;
  }
  outline.seen[seen] = true;
  return outline;
}

}  // namespace

std::optional<Pushed> pushed_body(const Outline& came, const Outline& gone, const OccupancyGrid& map) {
  const bool agree = is_strip(came) && is_strip(gone) && are_parallel(came, gone) &&
                     std::abs(came.width_m - gone.width_m) <= kSameDepth_m;
  if (!agree) return std::nullopt;
  const bool came_is_longer = came.length_m >= gone.length_m;
  const Outline& longer = came_is_longer ? came : gone;
  const Outline& shorter = came_is_longer ? gone : came;
  const Pose2 strip_from_map = inverse({longer.centre.x(), longer.centre.y(), longer.heading_rad});
  const Point2 beside = strip_from_map * shorter.centre;
  const double depth_m = std::abs(beside.y());
  const bool is_opposite = shorter.length_m >= kSeenOfIt * longer.length_m && depth_m >= kLeastDepth_m &&
                           depth_m <= kMostDepth_m &&
                           std::abs(beside.x()) + 0.5 * shorter.length_m <= 0.5 * longer.length_m + kBeside_m;
  if (!is_opposite) return std::nullopt;
  const double came_y = came_is_longer ? 0.0 : beside.y();
  const double gone_y = came_is_longer ? beside.y() : 0.0;
  const double onward = came_y > gone_y ? 0.5 : -0.5;
  if (is_floor(longer, gone_y + onward * gone.width_m, came_y - onward * came.width_m, map)) return std::nullopt;
  return Pushed{across(longer, came_y - onward * came.width_m, gone_y - onward * gone.width_m),
                across(longer, gone_y + onward * gone.width_m, came_y + onward * came.width_m)};
}

}  // namespace deltamap::mapping::things
