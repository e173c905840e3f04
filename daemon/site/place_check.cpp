// SPDX-License-Identifier: Apache-2.0
#include "daemon/site/place_check.hpp"

#include <map>
#include <stdexcept>

namespace deltamap::daemon {
namespace {

constexpr double kLeastArea_m2 = 0.01;

constexpr double kBorder_m = 5e-4;  // a corner counts to a millimetre

std::string point_text(const Point2& point) { return in_mm(point.x()) + ", " + in_mm(point.y()); }

}  // namespace

std::string name_of_place(const std::string& file, const std::string& what, const ListedPlace& place) {
  const std::string line = place.line > 0 ? "line " + std::to_string(place.line) + ": " : "";
  return file + ": " + line + what + " '" + place.id + "'";
}

void require_sound(const std::vector<ListedPlace>& places, const std::string& file, const std::string& what) {
  std::map<std::string, int> lines;
  for (const ListedPlace& place : places) {
    const auto refuse = [&](const std::string& why) {
      throw std::runtime_error(name_of_place(file, what, place) + " " + why);
    };
    const auto [first, is_new] = lines.emplace(place.id, place.line);
    if (!is_new)
      refuse("stands twice" + (first->second > 0 ? ": first in line " + std::to_string(first->second) : "") +
             ": each needs an id of its own");
    if (place.polygon.size() < 3) refuse("needs at least three corners");
    if (const auto sides = crossing_sides(place.polygon))
      refuse("crosses itself: its side from corner " + std::to_string(sides->first + 1) + " meets that from corner " +
             std::to_string(sides->second + 1) + ": give the corners in their order");
    if (area_m2(place.polygon) < kLeastArea_m2) refuse("has no floor");
  }
}

void require_on_map(const std::vector<ListedPlace>& places, const std::string& file, const std::string& what,
                    const GridGeometry& map) {
  const Point2 high = map.origin + map.resolution_m * Point2{map.width, map.height};
  for (const ListedPlace& place : places) {
    for (const Point2& corner : place.polygon) {
      const bool is_above = (corner.array() >= map.origin.array() - kBorder_m).all();
      if (is_above && (corner.array() <= high.array() + kBorder_m).all()) continue;
      throw std::runtime_error(name_of_place(file, what, place) + " lies off the map: its corner " +
                               point_text(corner) + "; the map reaches from " + point_text(map.origin) + " to " +
                               point_text(high) + ", in metres");
    }
  }
}

}  // namespace deltamap::daemon
