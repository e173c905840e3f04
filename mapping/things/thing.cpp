// SPDX-License-Identifier: Apache-2.0
#include "mapping/things/thing.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "core/counted.hpp"

namespace deltamap::mapping::things {
namespace {

constexpr int kSamples = 24;  // along each side of a rectangle
constexpr double kContainerLeast_m = 1.5;

Pose2 map_from_outline(const Outline& outline) { return {outline.centre.x(), outline.centre.y(), outline.heading_rad}; }

const char* likeness_of(const Outline& outline) {
  if (outline.width_m < kOneFace_m) return "face";
  return outline.width_m >= kContainerLeast_m ? "container-like body" : "body";
}

std::string place_text(const Outline& outline) {
  char text[48];
  (void)std::snprintf(text, sizeof text, "%.2f, %.2f", outline.centre.x(), outline.centre.y());
  return text;
}

std::string body_text(const Outline& outline) {
  char size[48];
  (void)std::snprintf(size, sizeof size, " of %.1f × %.1f m", outline.length_m, outline.width_m);
  const auto assumed = std::count(outline.assumed.begin(), outline.assumed.end(), true);
  const std::string sides =
      assumed == 0 ? "" : " (" + counted(static_cast<std::uint64_t>(assumed), "side") + " assumed)";
  return likeness_of(outline) + std::string{size} + sides;
}

}  // namespace

std::array<Point2, 4> corners(const Outline& outline) {
  const Pose2 map = map_from_outline(outline);
  const double x = 0.5 * outline.length_m;
  const double y = 0.5 * outline.width_m;
  return {map * Point2{x, -y}, map * Point2{x, y}, map * Point2{-x, y}, map * Point2{-x, -y}};
}

bool is_closed(const Outline& outline) {
  for (std::size_t side = 0; side < outline.seen.size(); ++side) {
    if (!outline.seen[side] && !outline.assumed[side]) return false;
  }
  return true;
}

bool is_inside(const Outline& outline, const Point2& place, double margin_m) {
  const Point2 away = place - outline.centre;
  const double cosine = std::cos(outline.heading_rad);
  const double sine = std::sin(outline.heading_rad);
  return std::abs(cosine * away.x() + sine * away.y()) <= 0.5 * outline.length_m + margin_m &&
         std::abs(cosine * away.y() - sine * away.x()) <= 0.5 * outline.width_m + margin_m;
}

double overlap_share(const Outline& a, const Outline& b) {
  const bool a_is_smaller = a.length_m * a.width_m <= b.length_m * b.width_m;
  const Outline& smaller = a_is_smaller ? a : b;
  const Outline& larger = a_is_smaller ? b : a;
  const Pose2 map = map_from_outline(smaller);
  int inside = 0;
  for (int i = 0; i < kSamples; ++i) {
    for (int j = 0; j < kSamples; ++j) {
      const Point2 own{((i + 0.5) / kSamples - 0.5) * smaller.length_m, ((j + 0.5) / kSamples - 0.5) * smaller.width_m};
      inside += is_inside(larger, map * own, 0.0) ? 1 : 0;
    }
  }
  return inside / static_cast<double>(kSamples * kSamples);
}

std::string_view name_of(ThingKind kind) {
  switch (kind) {
    case ThingKind::kAppeared:
      return "appeared";
    case ThingKind::kGone:
      return "gone";
    case ThingKind::kMoved:
      return "moved";
    case ThingKind::kChanged:
      return "changed";
    case ThingKind::kTakenBack:
      return "taken back";
    case ThingKind::kJoined:
      return "joined";
  }
  return "?";
}

std::string words_of(const Thing& thing) {
  std::string body = body_text(thing.outline());
  switch (thing.kind) {
    case ThingKind::kAppeared:
      return body + " appeared at " + place_text(*thing.at);
    case ThingKind::kGone:
      return body + " left " + place_text(*thing.from);
    case ThingKind::kMoved:
      return body + " moved from " + place_text(*thing.from) + " to " + place_text(*thing.at);
    case ThingKind::kChanged:
      return body + " changed its shape at " + place_text(*thing.at);
    case ThingKind::kTakenBack:
      return body + " at " + place_text(thing.outline()) + " is taken back";
    case ThingKind::kJoined:
      return body + " at " + place_text(thing.outline()) + " is part of thing " + std::to_string(thing.joined_into);
  }
  return body;
}

}  // namespace deltamap::mapping::things
