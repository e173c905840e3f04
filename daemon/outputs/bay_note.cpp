// SPDX-License-Identifier: Apache-2.0
#include "daemon/outputs/bay_note.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <nlohmann/json.hpp>

namespace deltamap::daemon {
namespace {

using mapping::bays::Bay;
using mapping::bays::BayEvent;
using mapping::bays::BayState;
using mapping::bays::BayStatus;
using mapping::things::Thing;
using BayJson = nlohmann::ordered_json;

constexpr double kStandsIn = 0.1;  // of the bay, or of the thing, that both cover
constexpr double kThingSample_m = 0.1;

double in_hundredths(double value) { return std::round(1e2 * value) / 1e2; }

BayJson instant_or_null(const std::optional<Timestamp>& time) {
  return time ? BayJson(unix_seconds(*time)) : BayJson(nullptr);
}

void add_status(BayJson& json, const BayStatus& status, Timestamp now) {
  const bool is_known = status.state != BayState::kUnknown;
  json["state"] = name_of(status.state);
  json["share"] = is_known ? BayJson(in_hundredths(status.share)) : BayJson(nullptr);
  json["confidence"] = in_hundredths(is_known ? status.confidence : 0.0);
  json["last_seen"] = instant_or_null(status.seen);
  json["age_s"] = status.seen ? BayJson(std::round(10.0 * seconds(now - *status.seen)) / 10.0) : BayJson(nullptr);
  json["since"] = instant_or_null(status.since);
}

void add_bay(BayJson& json, const Bay& bay) {
  json["bay"] = bay.id;
  if (!bay.name.empty()) json["name"] = bay.name;
  if (!bay.station_id.empty()) json["stationId"] = bay.station_id;
}

}  // namespace

std::vector<std::uint32_t> things_in(const Bay& bay, const std::vector<Thing>& things) {
  std::vector<std::uint32_t> ids;
  for (const Thing& thing : things) {
    if (!thing.at) continue;
    const auto outline = corners(*thing.at);
    const Polygon polygon{outline.begin(), outline.end()};
    const double least = std::min(area_m2(bay.polygon), area_m2(polygon));
    if (least > 0.0 && shared_area_m2(bay.polygon, polygon, kThingSample_m) >= kStandsIn * least)
      ids.push_back(thing.id);
  }
  return ids;
}

std::string json_line(const BayEvent& event, const std::vector<Thing>& things) {
  BayJson json{{"time", unix_seconds(event.time)}};
  add_bay(json, event.bay);
  json["before"] = name_of(event.before);
  add_status(json, event.status, event.time);
  json["things"] = things_in(event.bay, things);
  return json.dump(-1, ' ', false, BayJson::error_handler_t::replace) + "\n";
}

std::string json_of(const BayList& list, const ThingList& things, Timestamp now) {
  BayJson json{{"ok", true}, {"time", unix_seconds(now)}, {"bays", BayJson::array()}};
  for (std::size_t i = 0; i < list.bays.size(); ++i) {
    BayJson bay;
    add_bay(bay, list.bays[i]);
    add_status(bay, list.statuses[i], now);
    if (i < list.is_remembered.size() && list.is_remembered[i]) bay["remembered"] = true;
    bay["things"] = things_in(list.bays[i], things.things);
    bay["polygon_m"] = BayJson::array();
    for (const Point2& corner : list.bays[i].polygon) bay["polygon_m"].push_back({corner.x(), corner.y()});
    json["bays"].push_back(std::move(bay));
  }
  return json.dump(-1, ' ', false, BayJson::error_handler_t::replace);
}

std::string words_of(const BayEvent& event) {
  std::string words = "bay " + event.bay.id + ": " + std::string(name_of(event.status.state)) + ", was " +
                      std::string(name_of(event.before));
  if (event.status.state == BayState::kUnknown) return words;
  char share[48];
  (void)std::snprintf(share, sizeof share, "; %.2f of its floor is taken", event.status.share);
  return words + share;
}

}  // namespace deltamap::daemon
