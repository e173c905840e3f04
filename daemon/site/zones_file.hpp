// SPDX-License-Identifier: Apache-2.0
// zones.yaml: zones of a site, named as VDA 5050 names them.
//   zones:
//     - zoneId: walls
//       zoneType: FROZEN          # FROZEN, TEMPORARY, IGNORE, BLOCKED or SPEED_LIMIT
//       zoneDescriptor: the north wall
//       vertices: [{x: 0.0, y: 9.5}, {x: 20.0, y: 9.5}, {x: 20.0, y: 10.5}, {x: 0.0, y: 10.5}]
//     - zoneId: gate
//       zoneType: SPEED_LIMIT
//       maximumSpeed: 0.3         # m/s
//       vertices: [[4.0, 4.0], [6.0, 4.0], [6.0, 6.0]]
#pragma once

#include <string>

#include "core/grid/grid_geometry.hpp"
#include "core/zones.hpp"
#include "daemon/site/place_list.hpp"

namespace deltamap::daemon {

/// As in a file: "FROZEN".
[[nodiscard]] std::string_view name_of(ZoneKind kind);

/// None where no file is named. Throws std::runtime_error: one line with file, line and zone where it cannot be read,
/// an id stands twice, a polygon crosses itself, or one lies off the map.
[[nodiscard]] Zones zones_on(const GridGeometry& map, const std::string& file);
/// `name` stands for the text; whether they lie on the map is not asked.
[[nodiscard]] Zones zones_of_text(const std::string& yaml, const std::string& name);
[[nodiscard]] std::string zones_as_yaml(const Zones& zones);

[[nodiscard]] const PlaceKeys& zone_keys();
/// As a file lists them, in none.
[[nodiscard]] std::vector<ListedPlace> places_of(const Zones& zones);
/// Checked as those of a file on this map. Throws std::runtime_error.
[[nodiscard]] Zones zones_of_places(const std::vector<ListedPlace>& places, const std::string& name,
                                    const GridGeometry& map);

}  // namespace deltamap::daemon
