// SPDX-License-Identifier: Apache-2.0
#include "daemon/outputs/site_json.hpp"

#include <nlohmann/json.hpp>

#include "daemon/site/bays_file.hpp"
#include "daemon/site/site_edit.hpp"
#include "daemon/site/zones_file.hpp"

namespace deltamap::daemon {
namespace {

using SiteJson = nlohmann::ordered_json;

SiteJson places_as_json(const std::vector<ListedPlace>& places, const PlaceKeys& keys) {
  SiteJson list = SiteJson::array();
  for (const ListedPlace& place : places) {
    SiteJson json{{keys.id, place.id}};
    for (const auto& [key, word] : place.words) json[key] = word;
    json[keys.polygon] = SiteJson::array();
    for (const Point2& corner : place.polygon) json[keys.polygon].push_back({corner.x(), corner.y()});
    list.push_back(std::move(json));
  }
  return list;
}

}  // namespace

std::string json_of(const Site& site, const Settings& settings) {
  SiteJson json{{"ok", true}};
  json["bays"] = {{"file", settings.bays.file},
                  {"version", version_of(site, PlaceKind::kBay)},
                  {"places", places_as_json(places_of(site.bays), bay_keys())}};
  json["zones"] = {{"file", settings.zones.file},
                   {"version", version_of(site, PlaceKind::kZone)},
                   {"places", places_as_json(places_of(site.zones), zone_keys())}};
  return json.dump(-1, ' ', false, SiteJson::error_handler_t::replace);
}

}  // namespace deltamap::daemon
