// SPDX-License-Identifier: Apache-2.0
#include "daemon/site/bays_file.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "core/files/shortest_text.hpp"
#include "core/files/text_of_file.hpp"
#include "daemon/site/place_check.hpp"
#include "daemon/site/place_list.hpp"

namespace deltamap::daemon {
namespace {

using mapping::bays::Bay;

const PlaceKeys kBayKeys{"bays", "id", "polygon", {"name", "stationId"}};
constexpr double kLeastFloor_m2 = 0.3;  // half a pallet
constexpr double kSampleStep_m = 0.05;  // of the area that two share
constexpr double kMostShared = 0.02;    // of the smaller one: drawn by hand, they may touch

std::vector<Bay> bays_of(const std::vector<ListedPlace>& places) {
  std::vector<Bay> bays;
  for (const ListedPlace& place : places) {
    const auto word = [&](const char* key) {
      const auto found = place.words.find(key);
      return found == place.words.end() ? std::string{} : found->second;
    };
    bays.push_back({.id = place.id, .name = word("name"), .station_id = word("stationId"), .polygon = place.polygon});
  }
  return bays;
}

void require_apart(const std::vector<ListedPlace>& places, const std::string& file) {
  for (std::size_t late = 0; late < places.size(); ++late) {
    for (std::size_t early = 0; early < late; ++early) {
      const Polygon& a = places[late].polygon;
      const Polygon& b = places[early].polygon;
      const double shared = shared_area_m2(a, b, kSampleStep_m);
      if (shared <= kMostShared * std::min(area_m2(a), area_m2(b))) continue;
      throw std::runtime_error(name_of_place(file, "bay", places[late]) + " overlaps bay '" + places[early].id +
                               "' by " + shortest_text(std::round(100.0 * shared) / 100.0) +
                               " m²: what stands there would count twice");
    }
  }
}

void require_sound_places(const std::vector<ListedPlace>& places, const std::string& file) {
  require_sound(places, file, "bay");
  for (const ListedPlace& place : places) {
    if (area_m2(place.polygon) < kLeastFloor_m2)
      throw std::runtime_error(name_of_place(file, "bay", place) +
                               " is smaller than 0.3 m²: nothing can be told of it, are its corners in metres?");
  }
  require_apart(places, file);
}

std::vector<ListedPlace> read_places(const std::filesystem::path& file) {
  std::string text;
  try {
    text = text_of_file(file);
  } catch (const std::exception& error) {
    throw std::runtime_error(file.string() + ": " + error.what());
  }
  std::vector<ListedPlace> places = places_in(text, file.string(), kBayKeys);
  require_sound_places(places, file.string());
  return places;
}

}  // namespace

std::vector<Bay> bays_of_text(const std::string& yaml, const std::string& name) {
  const std::vector<ListedPlace> places = places_in(yaml, name, kBayKeys);
  require_sound_places(places, name);
  return bays_of(places);
}

std::vector<Bay> read_bays(const std::filesystem::path& file) { return bays_of(read_places(file)); }

std::vector<Bay> bays_on(const GridGeometry& map, const std::string& file) {
  if (file.empty()) return {};
  const std::vector<ListedPlace> places = read_places(file);
  require_on_map(places, file, "bay", map);
  return bays_of(places);
}

std::vector<Bay> bays_of_places(const std::vector<ListedPlace>& places, const std::string& name,
                                const GridGeometry& map) {
  require_on_map(places, name, "bay", map);  // first: what is as large as a town takes long to be held apart
  require_sound_places(places, name);
  return bays_of(places);
}

void require_sound_bays(const std::vector<Bay>& bays, const std::string& name) {
  require_sound_places(places_of(bays), name);
}

void require_bays_on(const GridGeometry& map, const std::vector<Bay>& bays, const std::string& name) {
  require_on_map(places_of(bays), name, "bay", map);
}

std::string bays_as_yaml(const std::vector<Bay>& bays) { return places_as_yaml(places_of(bays), kBayKeys); }

const PlaceKeys& bay_keys() { return kBayKeys; }

std::vector<ListedPlace> places_of(const std::vector<Bay>& bays) {
  std::vector<ListedPlace> places;
  for (const Bay& bay : bays) {
    places.push_back({.id = bay.id, .polygon = bay.polygon});
    if (!bay.name.empty()) places.back().words["name"] = bay.name;
    if (!bay.station_id.empty()) places.back().words["stationId"] = bay.station_id;
  }
  return places;
}

}  // namespace deltamap::daemon
