// SPDX-License-Identifier: Apache-2.0
#include "daemon/site/site_edit.hpp"

#include <algorithm>
#include <stdexcept>
#include <vector>

#include "daemon/settings/fingerprint.hpp"
#include "daemon/site/bays_file.hpp"
#include "daemon/site/site.hpp"
#include "daemon/site/zones_file.hpp"

namespace deltamap::daemon {
namespace {

const PlaceKeys& keys_of(PlaceKind kind) { return kind == PlaceKind::kBay ? bay_keys() : zone_keys(); }

std::vector<ListedPlace> listed_places(const Site& site, PlaceKind kind) {
  return kind == PlaceKind::kBay ? places_of(site.bays) : places_of(site.zones);
}

/// JSON is YAML, too: what is sent is read as strictly as a file.
ListedPlace place_of(const SiteEdit& edit) {
  const PlaceKeys& keys = keys_of(edit.kind);
  auto places = places_in(keys.list + ": [" + edit.place + "]", "the " + std::string(name_of(edit.kind)), keys);
  if (places.size() != 1) throw std::runtime_error("one " + std::string(name_of(edit.kind)) + " at a time");
  return std::move(places.front());
}

}  // namespace

std::string file_text(const Site& site, PlaceKind kind) {
  return kind == PlaceKind::kBay ? bays_as_yaml(site.bays) : zones_as_yaml(site.zones);
}

std::string version_of(const Site& site, PlaceKind kind) { return hex_of(fingerprint_of(file_text(site, kind))); }

Site edited(const Site& site, const SiteEdit& edit, const GridGeometry& map, const std::string& file) {
  if (edit.of.empty() && edit.place.empty()) throw std::runtime_error("neither a place nor one to take away");
  std::vector<ListedPlace> places = listed_places(site, edit.kind);
  const auto at = std::find_if(places.begin(), places.end(), [&](const ListedPlace& one) { return one.id == edit.of; });
  if (!edit.of.empty() && at == places.end())
    throw std::runtime_error("there is no " + std::string(name_of(edit.kind)) + " '" + edit.of + "'");
  if (edit.place.empty()) {
    places.erase(at);
  } else if (edit.of.empty()) {
    places.push_back(place_of(edit));
  } else {
    *at = place_of(edit);
  }
  for (ListedPlace& place : places) place.line = 0;  // in no file yet
  Site wanted = site;
  if (edit.kind == PlaceKind::kBay) {
    wanted.bays = bays_of_places(places, file, map);
  } else {
    wanted.zones = zones_of_places(places, file, map);
  }
  return wanted;
}

}  // namespace deltamap::daemon
