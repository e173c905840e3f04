// SPDX-License-Identifier: Apache-2.0
// Bays and zones as people write them: a YAML list of polygons with an id and a few words each. Read strictly: an
// unknown key, a missing one or a value of another type is refused in one line with file and line.
#pragma once

#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "core/geometry/polygon.hpp"

namespace deltamap::daemon {

/// How a file names what it lists.
struct PlaceKeys {
  std::string list;     ///< "bays": the one key of the file
  std::string id;       ///< "id"
  std::string polygon;  ///< "polygon": corners, [x, y] or {x: …, y: …} each, m in the map frame; may be closed
  std::vector<std::string> words{};    ///< other keys, each may be missing
  std::vector<std::string> numbers{};  ///< those of `words` that are written as numbers, for other programs
};

struct ListedPlace {
  std::string id;
  Polygon polygon;
  std::map<std::string, std::string> words{};  ///< those that are there, as text
  int line = 0;                                ///< where it begins in the file, from 1; 0: in none

  friend bool operator==(const ListedPlace&, const ListedPlace&) = default;
};

/// Throws std::runtime_error "FILE: line N: no text file: it has the byte 00h", or "… a character that is not UTF-8 …".
void require_text(std::string_view text, const std::string& file);

/// To a millimetre, as corners are written and told; no "-0".
[[nodiscard]] std::string in_mm(double length_m);

/// Without corners that repeat the one before: GeoJSON, WKT and Shapely close an outline by its first, and CAD programs
/// double some. May leave fewer than three.
[[nodiscard]] Polygon without_repeated_corners(Polygon polygon);

/// `file` stands for the text in complaints. Corners count to a millimetre. Throws std::runtime_error.
[[nodiscard]] std::vector<ListedPlace> places_in(std::string_view yaml, const std::string& file, const PlaceKeys& keys);
/// What places_in() reads again, to a millimetre.
[[nodiscard]] std::string places_as_yaml(const std::vector<ListedPlace>& places, const PlaceKeys& keys);

}  // namespace deltamap::daemon
