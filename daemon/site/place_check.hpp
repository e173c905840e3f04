// SPDX-License-Identifier: Apache-2.0
// Whether a list of places can be meant: each has an id of its own, is a polygon, and lies on the map.
#pragma once

#include <string>
#include <vector>

#include "core/grid/grid_geometry.hpp"
#include "daemon/site/place_list.hpp"

namespace deltamap::daemon {

/// "bays.yaml: line 12: bay 'B4'", or without the line where it stands in none.
[[nodiscard]] std::string name_of_place(const std::string& file, const std::string& what, const ListedPlace& place);

/// `what` is "bay" or "zone". Throws std::runtime_error: one line for the first place that cannot be.
void require_sound(const std::vector<ListedPlace>& places, const std::string& file, const std::string& what);
/// Throws std::runtime_error: one line for the first place with a corner beyond the map.
void require_on_map(const std::vector<ListedPlace>& places, const std::string& file, const std::string& what,
                    const GridGeometry& map);

}  // namespace deltamap::daemon
