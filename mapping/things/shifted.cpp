// SPDX-License-Identifier: Apache-2.0
#include "mapping/things/shifted.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <vector>

#include "mapping/things/assumed.hpp"
#include "mapping/things/span.hpp"

namespace deltamap::mapping::things {
namespace {

constexpr double kSameExtent_m = 0.3;       // of two ends that are as long as each other
constexpr double kLeastShifted_m = 0.15;    // less is a correction of its place
constexpr double kMostFloor = 0.3;          // share of free cells from which on a place is floor
constexpr double kLeastShared = 1.0 / 3.0;  // of the floor, by both places
constexpr double kLeftUnseen = 0.5;         // share of what was left that need not have been seen
constexpr int kStrayFreed = 4;              // places, at most, by pose error
constexpr int kAcross = 16;                 // samples along and across

/// The ways to make it so large: where it is shorter it grows to the one side or to the other.
std::vector<Span> grown_to(const Span& seen, const std::array<double, 2>& size) {
  std::vector<Span> all{seen};
  for (const std::size_t axis : {0U, 1U}) {
    std::vector<Span> more;
    for (const Span& one : all) {
      Span up = one;
      Span down = one;
      if (one.extent(axis) >= size[axis] - kSameExtent_m) {
        up.low[axis] = one.middle(axis) - 0.5 * size[axis];
        up.high[axis] = one.middle(axis) + 0.5 * size[axis];
        more.push_back(up);
        continue;
      }
      up.high[axis] = one.low[axis] + size[axis];
      down.low[axis] = one.high[axis] - size[axis];
      more.push_back(up);
      more.push_back(down);
    }
    all = std::move(more);
  }
  return all;
}

/// Share of what is added to it for which this holds.
template <typename Holds>
double added_share(const Span& whole, const Span& seen, Holds&& holds) {
  int all = 0;
  int held = 0;
  for (int i = 0; i < kAcross; ++i) {
    for (int j = 0; j < kAcross; ++j) {
      const Point2 own{whole.low[0] + (i + 0.5) / kAcross * whole.extent(0),
                       whole.low[1] + (j + 0.5) / kAcross * whole.extent(1)};
      if (seen.has(own)) continue;
      ++all;
      held += holds(own) ? 1 : 0;
    }
  }
  return all == 0 ? 0.0 : static_cast<double>(held) / all;
}

/// Of the floor of both, which are as large as each other.
double shared_share(const Span& a, const Span& b) {
  double share = 1.0;
  for (const std::size_t axis : {0U, 1U}) {
    const double shared_m = std::min(a.high[axis], b.high[axis]) - std::max(a.low[axis], b.low[axis]);
    share *= std::max(0.0, shared_m) / std::max(a.extent(axis), b.extent(axis));
  }
  return share;
}

/// Both ends in the axes of the one whose size is known.
struct Ends {
  Pose2 axes;
  std::array<double, 2> size;
  Span came;
  Span gone;
  std::array<bool, 4> came_seen{};  // sides of the end that is known; of the other it is not known which they are
  std::array<bool, 4> gone_seen{};
};

std::optional<Ends> ends_of(const ShiftEnd& came, const ShiftEnd& gone) {
  if (!came.is_whole && !gone.is_whole) return std::nullopt;
  const auto area_m2 = [](const ShiftEnd& end) {
    return end.is_whole ? end.outline.length_m * end.outline.width_m : 0.0;
  };
  const bool by_came = area_m2(came) >= area_m2(gone);
  const Outline& known = by_came ? came.outline : gone.outline;
  const Outline& other = by_came ? gone.outline : came.outline;
  if (other.width_m >= kOneFace_m && !are_parallel(known, other)) return std::nullopt;
  const Pose2 axes = map_from_axes(known);
  Ends ends{axes, {known.length_m, known.width_m}, span_of(came.outline, axes), span_of(gone.outline, axes)};
  (by_came ? ends.came_seen : ends.gone_seen) = known.seen;
  const Span& part = by_came ? ends.gone : ends.came;
  const bool fits = part.extent(0) <= ends.size[0] + kSameExtent_m && part.extent(1) <= ends.size[1] + kSameExtent_m;
  return fits ? std::optional{ends} : std::nullopt;
}

/// It may stand there: what was not seen of it lies on no floor, and no floor was left there.
bool may_stand(const Span& at, const Ends& ends, std::span<const Point2> freed, const OccupancyGrid& map) {
  const Outline outline = outline_of(at, ends.axes, {});
  const auto is_floor = [&](const Point2& own) {
    return map.at(map.geometry().cell_at(ends.axes * own)) == CellState::kFree;
  };
  const auto within =
      std::count_if(freed.begin(), freed.end(), [&](const Point2& place) { return is_deep_inside(outline, place); });
  return within <= kStrayFreed && added_share(at, ends.came, is_floor) <= kMostFloor;
}

/// It may have stood there: what was not seen to go is hidden, and most of what is not hidden was seen to go.
bool may_have_stood(const Span& from, const Span& at, const Ends& ends) {
  return shared_share(at, from) >= kLeastShared &&
         added_share(from, ends.gone, [&](const Point2& own) { return !at.has(own); }) <= kMostFloor &&
         added_share(from, at, [&](const Point2& own) { return !ends.gone.has(own); }) <= kLeftUnseen;
}

}  // namespace

std::optional<Pushed> shifted_body(const ShiftEnd& came, const ShiftEnd& gone, std::span<const Point2> freed,
                                   const OccupancyGrid& map) {
  const std::optional<Ends> ends = ends_of(came, gone);
  if (!ends) return std::nullopt;
  std::optional<Pushed> nearest;
  double nearest_m = std::numeric_limits<double>::infinity();
  for (const Span& at : grown_to(ends->came, ends->size)) {
    if (!may_stand(at, *ends, freed, map)) continue;
    for (const Span& from : grown_to(ends->gone, ends->size)) {
      const double shift_m = std::hypot(at.middle(0) - from.middle(0), at.middle(1) - from.middle(1));
      if (shift_m < kLeastShifted_m || shift_m >= nearest_m || !may_have_stood(from, at, *ends)) continue;
      nearest_m = shift_m;
      nearest = Pushed{outline_of(from, ends->axes, ends->gone_seen), outline_of(at, ends->axes, ends->came_seen)};
    }
  }
  return nearest;
}

}  // namespace deltamap::mapping::things
