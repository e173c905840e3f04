// SPDX-License-Identifier: Apache-2.0
// bays.yaml: the bays of a site.
//   bays:
//     - id: B4
//       name: Row B, bay 4
//       stationId: ST-17
//       polygon: [[8.0, 8.0], [10.4, 8.0], [10.4, 10.4], [8.0, 10.4]]
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "core/grid/grid_geometry.hpp"
#include "daemon/site/place_list.hpp"
#include "mapping/bays/bay.hpp"

namespace deltamap::daemon {

/// Throws std::runtime_error: one line with file, line and bay where it cannot be read, an id stands twice, a polygon
/// crosses itself or is too small to be judged, or two overlap.
[[nodiscard]] std::vector<mapping::bays::Bay> read_bays(const std::filesystem::path& file);
[[nodiscard]] std::vector<mapping::bays::Bay> bays_of_text(const std::string& yaml, const std::string& name);
/// The same, where one lies off the map, too. None where no file is named.
[[nodiscard]] std::vector<mapping::bays::Bay> bays_on(const GridGeometry& map, const std::string& file);
/// The same of bays that stand in no file yet; `name` stands for it.
void require_sound_bays(const std::vector<mapping::bays::Bay>& bays, const std::string& name);

void require_bays_on(const GridGeometry& map, const std::vector<mapping::bays::Bay>& bays, const std::string& name);

[[nodiscard]] std::string bays_as_yaml(const std::vector<mapping::bays::Bay>& bays);

[[nodiscard]] const PlaceKeys& bay_keys();
/// As a file lists them, in none.
[[nodiscard]] std::vector<ListedPlace> places_of(const std::vector<mapping::bays::Bay>& bays);
/// Checked as those of a file on this map. Throws std::runtime_error.
[[nodiscard]] std::vector<mapping::bays::Bay> bays_of_places(const std::vector<ListedPlace>& places,
                                                             const std::string& name, const GridGeometry& map);

}  // namespace deltamap::daemon
