// SPDX-License-Identifier: Apache-2.0
#include "daemon/site/zones_file.hpp"

#include <array>
#include <charconv>
#include <stdexcept>
#include <utility>

#include "core/files/shortest_text.hpp"
#include "core/files/text_of_file.hpp"
#include "daemon/site/place_check.hpp"
#include "daemon/site/place_list.hpp"

namespace deltamap::daemon {
namespace {

const PlaceKeys kZoneKeys{
    "zones", "zoneId", "vertices", {"zoneType", "zoneDescriptor", "maximumSpeed"}, {"maximumSpeed"}};
constexpr std::array<std::pair<std::string_view, ZoneKind>, 5> kZoneKinds{{{"FROZEN", ZoneKind::kFrozen},
                                                                           {"TEMPORARY", ZoneKind::kTemporary},
                                                                           {"IGNORE", ZoneKind::kIgnore},
                                                                           {"BLOCKED", ZoneKind::kBlocked},
                                                                           {"SPEED_LIMIT", ZoneKind::kSpeedLimit}}};

[[noreturn]] void refuse_zone(const std::string& file, const ListedPlace& place, const std::string& why) {
  throw std::runtime_error(name_of_place(file, "zone", place) + " " + why);
}

std::string word_of(const ListedPlace& place, const char* key) {
  const auto found = place.words.find(key);
  return found == place.words.end() ? std::string{} : found->second;
}

ZoneKind kind_of(const ListedPlace& place, const std::string& file) {
  const std::string word = word_of(place, "zoneType");
  for (const auto& [name, kind] : kZoneKinds) {
    if (name == word) return kind;
  }
  refuse_zone(file, place,
              (word.empty() ? "has no zoneType" : "has the unknown zoneType '" + word + "'") +
                  ": FROZEN, TEMPORARY, IGNORE, BLOCKED or SPEED_LIMIT");
}

constexpr double kLeastSpeed_m_per_s = 0.05;  // slower no robot drives

double speed_of(const ListedPlace& place, const std::string& file) {
  const std::string word = word_of(place, "maximumSpeed");
  double speed = 0.0;
  const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), speed);
  if (error != std::errc{} || end != word.data() + word.size() || !(speed >= kLeastSpeed_m_per_s && speed <= 10.0))
    refuse_zone(file, place, "needs a maximumSpeed from 0.05 to 10 m/s; where nobody may drive it is BLOCKED");
  return speed;
}

Zones zones_of(const std::vector<ListedPlace>& places, const std::string& file) {
  Zones zones;
  for (const ListedPlace& place : places) {
    Zone zone{.id = place.id,
              .description = word_of(place, "zoneDescriptor"),
              .kind = kind_of(place, file),
              .polygon = place.polygon};
    if (zone.kind == ZoneKind::kSpeedLimit) {
      zone.most_speed_m_per_s = speed_of(place, file);
    } else if (place.words.contains("maximumSpeed")) {
      refuse_zone(file, place, "has a maximumSpeed, which only SPEED_LIMIT has");
    }
    zones.push_back(std::move(zone));
  }
  return zones;
}

}  // namespace

std::string_view name_of(ZoneKind kind) { return kZoneKinds[static_cast<std::size_t>(kind)].first; }

Zones zones_of_text(const std::string& yaml, const std::string& name) {
  const std::vector<ListedPlace> places = places_in(yaml, name, kZoneKeys);
  require_sound(places, name, "zone");
  return zones_of(places, name);
}

Zones zones_on(const GridGeometry& map, const std::string& file) {
  if (file.empty()) return {};
  std::string text;
  try {
    text = text_of_file(file);
  } catch (const std::exception& error) {
    throw std::runtime_error(file + ": " + error.what());
  }
  return zones_of_places(places_in(text, file, kZoneKeys), file, map);
}

Zones zones_of_places(const std::vector<ListedPlace>& places, const std::string& name, const GridGeometry& map) {
  require_sound(places, name, "zone");
  require_on_map(places, name, "zone", map);
  return zones_of(places, name);
}

std::string zones_as_yaml(const Zones& zones) { return places_as_yaml(places_of(zones), kZoneKeys); }

const PlaceKeys& zone_keys() { return kZoneKeys; }

std::vector<ListedPlace> places_of(const Zones& zones) {
  std::vector<ListedPlace> places;
  for (const Zone& zone : zones) {
    places.push_back({.id = zone.id, .polygon = zone.polygon});
    auto& words = places.back().words;
    words["zoneType"] = name_of(zone.kind);
    if (!zone.description.empty()) words["zoneDescriptor"] = zone.description;
    if (zone.kind == ZoneKind::kSpeedLimit) words["maximumSpeed"] = shortest_text(zone.most_speed_m_per_s);
  }
  return places;
}

}  // namespace deltamap::daemon
