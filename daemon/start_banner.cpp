// SPDX-License-Identifier: Apache-2.0
#include "daemon/start_banner.hpp"

#include "core/files/shortest_text.hpp"
#include "daemon/settings/provenance.hpp"

namespace deltamap::daemon {

std::string size_text(const GridGeometry& map) {
  return std::to_string(map.width) + " x " + std::to_string(map.height) + " cells of " +
         shortest_text(map.resolution_m) + " m";
}

std::vector<std::string> start_banner(const Settings& settings, const std::string& config, const GridGeometry& map,
                                      std::optional<std::uint32_t> revision) {
  std::vector<std::string> lines{"deltamapd " + version_text()};
  lines.push_back("settings: file=" + config + " changed=" + std::to_string(changed_settings(settings).size()) +
                  " fingerprint=" + hex_of(settings_fingerprint(settings)));
  lines.push_back("map: file=" + settings.map.file + " size=" + size_text(map));
  lines.push_back(revision ? "store: file=" + settings.map.store + " revision=" + std::to_string(*revision)
                           : "store: none, the map is not kept across restarts");
  lines.push_back("ports: robot=" + settings.robot.port + " laser=" + settings.laser.port +
                  " laser_baud=" + std::to_string(settings.laser.session.baud));
  lines.push_back("drive: mode=" + std::string(name_of(settings.navigation.mode)));
  return lines;
}

}  // namespace deltamap::daemon
