// SPDX-License-Identifier: Apache-2.0
// What people have drawn on the map: bays and zones. Never changed once it travels.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "core/grid/grid_geometry.hpp"
#include "core/zones.hpp"
#include "mapping/bays/bay.hpp"

namespace deltamap::daemon {

struct Site {
  std::vector<mapping::bays::Bay> bays{};
  Zones zones{};

  friend bool operator==(const Site&, const Site&) = default;
};
using SharedSite = std::shared_ptr<const Site>;

/// From both files; an empty name: none. Throws std::runtime_error: one line that names file and place.
[[nodiscard]] SharedSite site_on(const GridGeometry& map, const std::string& bays_file, const std::string& zones_file);

/// For a recording: exact to the millimetre that the files are read to.
[[nodiscard]] std::string text_of(const Site& site);
/// Null where it is no such text.
[[nodiscard]] SharedSite site_of_text(const std::string& text);

}  // namespace deltamap::daemon
