// SPDX-License-Identifier: Apache-2.0
#include "daemon/incidents/incident.hpp"

#include <algorithm>
#include <nlohmann/json.hpp>
#include <stdexcept>

#include "core/files/text_of_file.hpp"
#include "core/geometry/angle.hpp"
#include "core/utc_text.hpp"

namespace deltamap::daemon {
namespace {

using Json = nlohmann::ordered_json;
namespace fs = std::filesystem;

constexpr std::array<std::string_view, kIncidentKinds> kKindNames{
    "mark", "lost", "kidnapped", "refusals", "safety-stop", "device-fault", "daemon-ended"};
constexpr std::size_t kLargestFacts = 1 << 20;

Json event_json(const IncidentEvent& event) {
  return {{"kind", name_of(event.kind)},
          {"time", utc_text(event.time)},
          {"time_ns", unix_ns(event.time)},
          {"words", event.words}};
}

/// Throws Json::exception; std::runtime_error for a kind that is not known.
IncidentEvent event_in(const Json& json) {
  const auto kind = incident_kind_of(json.at("kind").get<std::string>());
  if (!kind) throw std::runtime_error("names a kind of incident that is not known");
  return {*kind, timestamp_from_ns(json.at("time_ns").get<std::int64_t>()), json.at("words").get<std::string>()};
}

Incident incident_in(const Json& json) {
  Incident incident;
  incident.name = json.at("name").get<std::string>();
  for (const Json& event : json.at("events")) incident.events.push_back(event_in(event));
  if (incident.events.empty()) throw std::runtime_error("tells of no event");
  incident.from = timestamp_from_ns(json.at("from_ns").get<std::int64_t>());
  if (const Json& to = json.at("to_ns"); !to.is_null()) incident.to = timestamp_from_ns(to.get<std::int64_t>());
  incident.begins_in_mid_run = json.at("begins_in_mid_run").get<bool>();
  if (const Json& pose = json.at("pose"); !pose.is_null()) {
    incident.map_from_robot = Pose2{pose.at("x_m").get<double>(), pose.at("y_m").get<double>(),
                                    radians(pose.at("heading_deg").get<double>())};
    incident.is_sure = pose.at("sure").get<bool>();
    incident.deviation_m = pose.at("deviation_m").get<double>();
  }
  incident.revision = json.at("revision").get<std::uint32_t>();
  incident.first_revision = json.at("first_revision").get<std::uint32_t>();
  incident.first_map = json.at("first_map").get<std::string>();
  incident.version = json.at("version").get<std::string>();
  incident.lacks = json.value("lacks", "");  // not in those of earlier versions
  return incident;
}

}  // namespace

std::string_view name_of(IncidentKind kind) { return kKindNames.at(static_cast<std::size_t>(kind)); }

std::optional<IncidentKind> incident_kind_of(std::string_view name) {
  const auto found = std::find(kKindNames.begin(), kKindNames.end(), name);
  if (found == kKindNames.end()) return std::nullopt;
  return static_cast<IncidentKind>(found - kKindNames.begin());
}

std::string json_text(const Incident& incident) {
  Json json{{"name", incident.name}};
  for (const IncidentEvent& event : incident.events) json["events"].push_back(event_json(event));
  json["from_ns"] = unix_ns(incident.from);
  json["to_ns"] = incident.to ? Json(unix_ns(*incident.to)) : Json(nullptr);
  json["begins_in_mid_run"] = incident.begins_in_mid_run;
  json["pose"] = nullptr;
  if (const auto& pose = incident.map_from_robot) {
    json["pose"] = {{"x_m", pose->x},
                    {"y_m", pose->y},
                    {"heading_deg", degrees(pose->theta)},
                    {"sure", incident.is_sure},
                    {"deviation_m", incident.deviation_m}};
  }
  json["revision"] = incident.revision;
  json["first_revision"] = incident.first_revision;
  json["first_map"] = incident.first_map;
  json["version"] = incident.version;
  json["lacks"] = incident.lacks;
  return json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

Incident incident_of(const std::string& json_text) {
  try {
    return incident_in(Json::parse(json_text));
  } catch (const Json::exception&) {
    throw std::runtime_error("is damaged");
  }
}

Incident read_incident(const fs::path& folder) {
  const fs::path file = folder / kIncidentFacts;
  std::error_code error;
  if (!fs::is_regular_file(file, error))
    throw std::runtime_error(folder.string() + ": is no incident: no " + kIncidentFacts);
  if (fs::file_size(file, error) > kLargestFacts || error) throw std::runtime_error(file.string() + ": is too large");
  try {
    return incident_of(text_of_file(file));
  } catch (const std::runtime_error& why) {
    throw std::runtime_error(file.string() + ": " + why.what());
  }
}

}  // namespace deltamap::daemon
