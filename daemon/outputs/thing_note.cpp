// SPDX-License-Identifier: Apache-2.0
#include "daemon/outputs/thing_note.hpp"

#include <cmath>
#include <nlohmann/json.hpp>

#include "core/geometry/angle.hpp"

namespace deltamap::daemon {
namespace {

using mapping::things::Outline;
using mapping::things::Thing;
using mapping::things::ThingEvent;
using ThingJson = nlohmann::ordered_json;

double rounded(double value, double per_unit) { return std::round(value * per_unit) / per_unit; }
double in_mm(double length_m) { return rounded(length_m, 1e3); }

ThingJson outline_as_json(const std::optional<Outline>& outline) {
  if (!outline) return nullptr;
  ThingJson json{{"x_m", in_mm(outline->centre.x())},
                 {"y_m", in_mm(outline->centre.y())},
                 {"length_m", in_mm(outline->length_m)},
                 {"width_m", in_mm(outline->width_m)},
                 {"heading_deg", rounded(degrees(outline->heading_rad), 10.0)},
                 {"polygon_m", ThingJson::array()},
                 {"sides_seen", outline->seen},
                 {"sides_assumed", outline->assumed}};
  for (const Point2& corner : corners(*outline)) json["polygon_m"].push_back({in_mm(corner.x()), in_mm(corner.y())});
  return json;
}

void add_thing(ThingJson& json, const Thing& thing) {
  json["thing"] = thing.id;
  json["kind"] = name_of(thing.kind);
  json["at"] = outline_as_json(thing.at);
  json["from"] = outline_as_json(thing.from);
  json["first_seen"] = unix_seconds(thing.first_seen);
  json["last_seen"] = unix_seconds(thing.last_seen);
  json["confidence"] = rounded(thing.confidence, 1e3);
  json["updates"] = thing.updates;
  if (thing.joined_into != 0) json["joined_into"] = thing.joined_into;
  json["revisions"] = thing.revisions;
  json["words"] = words_of(thing);
}

ThingJson as_json(const Thing& thing) {
  ThingJson json;
  add_thing(json, thing);
  return json;
}

}  // namespace

std::string json_line(const ThingEvent& event) {
  ThingJson json{{"time", unix_seconds(event.time)}, {"revision", event.revision}, {"new", event.is_new}};
  add_thing(json, event.thing);
  return json.dump() + "\n";
}

std::string json_of(const ThingList& list) {
  ThingJson json{
      {"ok", true}, {"things", ThingJson::array()}, {"corrections", list.corrections}, {"forgotten", list.forgotten}};
  for (const Thing& thing : list.things) json["things"].push_back(as_json(thing));
  return json.dump();
}

}  // namespace deltamap::daemon
