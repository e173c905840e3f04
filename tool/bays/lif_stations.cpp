// SPDX-License-Identifier: Apache-2.0
// Stations of a LIF file. Read loosely, as other programs extend it; what decides is checked.
#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <stdexcept>

#include "core/geometry/angle.hpp"
#include "tool/bays/bay_import.hpp"
#include "tool/bays/rectangle.hpp"

namespace deltamap::tool {
namespace {

using LifJson = nlohmann::json;

/// "site.lif: /layouts/0/stations/3: …"
[[noreturn]] void refuse_lif(const std::string& name, const std::string& place, const std::string& why) {
  throw std::runtime_error(name + ": " + (place.empty() ? "" : place + ": ") + why);
}

LifJson parsed_lif(const std::string& text, const std::string& name) {
  try {
    return LifJson::parse(text);
  } catch (const LifJson::parse_error& error) {
    const auto line =
        1 +
        std::count(text.begin(), text.begin() + static_cast<std::ptrdiff_t>(std::min(error.byte, text.size())), '\n');
    refuse_lif(name, "line " + std::to_string(line), "no JSON");
  } catch (const LifJson::out_of_range&) {  // nlohmann 3.11.2: out_of_range.406, no parse_error, and it says no place
    refuse_lif(name, "", "holds a number that is too large to be read");
  }
}

void require_lif_1(const LifJson& lif, const std::string& name) {
  const bool has_version = lif.is_object() && lif.contains("metaInformation") && lif["metaInformation"].is_object() &&
                           lif["metaInformation"].contains("lifVersion");
  if (!has_version) refuse_lif(name, "/metaInformation/lifVersion", "is missing: this is no LIF file");
  const LifJson& version = lif["metaInformation"]["lifVersion"];
  const std::string told = version.is_string() ? version.get<std::string>() : version.dump();
  if (told != "1" && !told.starts_with("1."))
    refuse_lif(name, "/metaInformation/lifVersion", "is '" + told + "': only LIF 1 is known, export it as 1.0.0");
}

const LifJson& list_in(const LifJson& json, const char* key, const std::string& name, const std::string& place) {
  static const LifJson kNone = LifJson::array();
  if (!json.is_object()) refuse_lif(name, place, "must be an object");
  const auto found = json.find(key);
  if (found == json.end()) return kNone;
  if (!found->is_array()) refuse_lif(name, place + "/" + key, "must be a list");
  return *found;
}

std::string text_in(const LifJson& json, const char* key) {
  const auto found = json.find(key);
  return found != json.end() && found->is_string() ? found->get<std::string>() : "";
}

/// Of a name that other programs write as a number, too.
std::string name_in(const LifJson& json, const char* key) {
  const auto found = json.find(key);
  return found != json.end() && found->is_number() ? found->dump() : text_in(json, key);
}

std::optional<double> number_at(const LifJson& json, const char* key) {
  const auto found = json.find(key);
  const bool is_number = found != json.end() && found->is_number() && std::isfinite(found->get<double>());
  return is_number ? std::optional{found->get<double>()} : std::nullopt;
}

void add_station(const LifJson& station, const std::string& name, const std::string& place,
                 const std::optional<BaySize>& size, ImportedBays& bays) {
  if (!station.is_object()) refuse_lif(name, place, "must be an object");
  const std::string id = text_in(station, "stationId");
  if (id.empty()) refuse_lif(name, place + "/stationId", "is missing");
  const auto position = station.find("stationPosition");
  if (position == station.end() || position->is_null()) {
    bays.left_out.push_back(name + ": " + place + ": station '" + id +
                            "' has no stationPosition: left out, draw its bay by hand");
    return;
  }
  const auto x_m = number_at(*position, "x");
  const auto y_m = number_at(*position, "y");
  if (!x_m || !y_m) refuse_lif(name, place + "/stationPosition", "needs the numbers x and y");
  if (!size) refuse_lif(name, place, "LIF has no size of stations: give --size ALONGxACROSS in metres");
  const auto theta_rad = number_at(*position, "theta");
  if (position->contains("theta") && !position->at("theta").is_null() && !theta_rad)
    refuse_lif(name, place + "/stationPosition/theta", "must be a number");
  const Pose2 map_from_bay{*x_m, *y_m, wrapped_angle(theta_rad.value_or(0.0))};
  bays.bays.push_back({.id = id,
                       .name = text_in(station, "stationName"),
                       .station_id = id,
                       .polygon = rectangle_of(map_from_bay, *size)});
}

/// One of a file's, as far as it concerns bays.
struct LifLayout {
  std::string place;  // "/layouts/0"
  std::string id;
  std::string level;  // floor; empty: not said
  const LifJson* stations = nullptr;
};

/// Those with stations.
std::vector<LifLayout> layouts_in(const LifJson& lif, const std::string& name) {
  std::vector<LifLayout> found;
  const LifJson& layouts = list_in(lif, "layouts", name, "");
  for (std::size_t i = 0; i < layouts.size(); ++i) {
    const std::string place = "/layouts/" + std::to_string(i);
    const LifJson& stations = list_in(layouts[i], "stations", name, place);
    if (stations.empty()) continue;
    found.push_back({place, name_in(layouts[i], "layoutId"), name_in(layouts[i], "layoutLevelId"), &stations});
  }
  return found;
}

bool is_wanted(const LifLayout& layout, const std::vector<std::string>& wanted) {
  return wanted.empty() || std::find(wanted.begin(), wanted.end(), layout.id) != wanted.end();
}

void require_layouts(const std::vector<LifLayout>& all, const std::vector<std::string>& wanted,
                     const std::string& name) {
  std::string known;
  for (const LifLayout& layout : all) {
    known += (known.empty() ? "'" : ", '") + layout.id + "'";
    if (!layout.level.empty()) known += " of level '" + layout.level + "'";
  }
  for (const std::string& id : wanted) {
    if (std::none_of(all.begin(), all.end(), [&](const LifLayout& layout) { return layout.id == id; }))
      refuse_lif(name, "/layouts", "has no '" + id + "' with stations: " + (known.empty() ? "none has any" : known));
  }
  const LifLayout* first = nullptr;
  for (const LifLayout& layout : all) {
    if (!is_wanted(layout, wanted)) continue;
    if (first == nullptr) first = &layout;
    if (layout.level != first->level)
      refuse_lif(name, "/layouts", "are of several levels, and a map is one: give --layout ID of " + known);
  }
}

}  // namespace

ImportedBays bays_of_lif(const std::string& text, const std::string& name, const std::optional<BaySize>& size,
                         const std::vector<std::string>& layouts) {
  const LifJson lif = parsed_lif(text, name);
  require_lif_1(lif, name);
  const std::vector<LifLayout> all = layouts_in(lif, name);
  require_layouts(all, layouts, name);
  ImportedBays bays;
  for (const LifLayout& layout : all) {
    if (!is_wanted(layout, layouts)) continue;
    for (std::size_t j = 0; j < layout.stations->size(); ++j)
      add_station((*layout.stations)[j], name, layout.place + "/stations/" + std::to_string(j), size, bays);
  }
  if (bays.bays.empty() && bays.left_out.empty()) refuse_lif(name, "/layouts", "holds no stations");
  return bays;
}

}  // namespace deltamap::tool
