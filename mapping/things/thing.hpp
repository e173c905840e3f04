// SPDX-License-Identifier: Apache-2.0
// What stands, or stood, in the map and was not there before: a body with an outline, told once and updated as more of
// it is seen. All places in the map frame.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/geometry/pose2.hpp"
#include "core/time.hpp"

namespace deltamap::mapping::things {

/// A body that is thinner was seen from one side: nobody knows how deep it is.
inline constexpr double kOneFace_m = 0.3;

/// A rectangle around a body. Side 0 is that of +length, then counter-clockwise: +width, -length, -width.
struct Outline {
  Point2 centre{0.0, 0.0};
  double length_m = 0.0;     ///< the longer side, along the heading
  double width_m = 0.0;      ///< <= length_m
  double heading_rad = 0.0;  ///< [0, π): a rectangle does not tell its front from its back
  std::array<bool, 4> seen{};
  /// Not seen, but taken to be there: the seen ones are sides of one rectangle. Of what stands there alone.
  std::array<bool, 4> assumed{};

  friend bool operator==(const Outline&, const Outline&) = default;
};

/// Counter-clockwise, from the corner of sides 3 and 0 on.
[[nodiscard]] std::array<Point2, 4> corners(const Outline& outline);
/// Every side is seen or assumed: its inside is solid.
[[nodiscard]] bool is_closed(const Outline& outline);
/// Within the rectangle, grown by a margin (m) on every side.
[[nodiscard]] bool is_inside(const Outline& outline, const Point2& place, double margin_m);
/// Area that both cover, of the smaller one's, by samples; [0, 1].
[[nodiscard]] double overlap_share(const Outline& a, const Outline& b);

enum class ThingKind : std::uint8_t {
  kAppeared,
  kGone,
  kMoved,      ///< gone there and come here
  kChanged,    ///< stands where it stood, in another shape
  kTakenBack,  ///< what told of it has been undone or withdrawn: it never was
  kJoined      ///< it has proven to be part of another thing
};

[[nodiscard]] std::string_view name_of(ThingKind kind);

struct Thing {
  static constexpr std::size_t kMostRevisions = 256;

  std::uint32_t id = 0;  ///< from 1, in the order in which they were first told
  ThingKind kind = ThingKind::kAppeared;
  std::optional<Outline> from{};  ///< where it stood; nothing: it has come, or stands where it stood
  std::optional<Outline> at{};    ///< where it stands; nothing: it has gone
  Timestamp first_seen;           ///< of the first revision that showed something of it
  Timestamp last_seen;            ///< of the newest that did
  double confidence = 0.0;        ///< share of the cells that were ever written for it and still hold, [0, 1]
  std::uint32_t updates = 0;
  std::uint32_t joined_into = 0;           ///< id of the thing that it is part of; 0: of none
  std::vector<std::uint32_t> revisions{};  ///< that it came from, ascending; the newest kMostRevisions

  friend bool operator==(const Thing&, const Thing&) = default;
  /// Where it stands, else where it stood. It has at least one of the two.
  [[nodiscard]] const Outline& outline() const { return at ? *at : *from; }
};

/// "container-like body of 2.4 × 2.5 m (2 sides assumed) appeared at 12.30, 4.05"
[[nodiscard]] std::string words_of(const Thing& thing);

}  // namespace deltamap::mapping::things
