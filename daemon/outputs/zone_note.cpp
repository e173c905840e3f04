// SPDX-License-Identifier: Apache-2.0
#include "daemon/outputs/zone_note.hpp"

#include <nlohmann/json.hpp>

#include "daemon/site/zones_file.hpp"

namespace deltamap::daemon {

std::string json_of(const Zones& zones) {
  nlohmann::ordered_json json{{"ok", true}, {"zones", nlohmann::ordered_json::array()}};
  for (const Zone& zone : zones) {
    nlohmann::ordered_json one{{"zoneId", zone.id}, {"zoneType", name_of(zone.kind)}};
    if (!zone.description.empty()) one["zoneDescriptor"] = zone.description;
    if (zone.kind == ZoneKind::kSpeedLimit) one["maximumSpeed"] = zone.most_speed_m_per_s;
    one["vertices"] = nlohmann::ordered_json::array();
    for (const Point2& corner : zone.polygon) one["vertices"].push_back({{"x", corner.x()}, {"y", corner.y()}});
    json["zones"].push_back(std::move(one));
  }
  return json.dump(-1, ' ', false, nlohmann::ordered_json::error_handler_t::replace);
}

}  // namespace deltamap::daemon
