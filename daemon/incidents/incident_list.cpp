// SPDX-License-Identifier: Apache-2.0
#include "daemon/incidents/incident_list.hpp"

#include <algorithm>
#include <cstdio>
#include <nlohmann/json.hpp>
#include <stdexcept>
#include <utility>

#include "core/counted.hpp"
#include "core/files/text_of_file.hpp"
#include "core/geometry/angle.hpp"
#include "core/utc_text.hpp"
#include "daemon/records/run_listener.hpp"

namespace deltamap::daemon {
namespace {

using Json = nlohmann::ordered_json;
namespace fs = std::filesystem;

std::uint64_t bytes_in(const fs::path& folder) {
  std::uint64_t bytes = 0;
  std::error_code error;
  for (const auto& entry : fs::directory_iterator(folder, error)) {
    std::error_code gone;
    const auto size = entry.file_size(gone);
    if (!gone) bytes += size;
  }
  return bytes;
}

std::string place_text(const Incident& incident) {
  if (!incident.map_from_robot) return "at no known pose";
  char at[96];
  (void)std::snprintf(at, sizeof at, "at %.2f, %.2f, %.0f°", incident.map_from_robot->x, incident.map_from_robot->y,
                      degrees(incident.map_from_robot->theta));
  if (incident.is_sure) return at;
  char doubt[64];
  (void)std::snprintf(doubt, sizeof doubt, " in doubt (deviation %.2f m)", incident.deviation_m);
  return std::string(at) + doubt;
}

bool has_picture(const StoredIncident& stored) {
  std::error_code error;
  return fs::is_regular_file(stored.folder / kIncidentPicture, error);
}

Json listed(const StoredIncident& stored) {
  const Incident& incident = stored.incident;
  const IncidentEvent& first = incident.events.front();
  Json json{{"name", incident.name},
            {"time", utc_text(first.time)},
            {"kind", name_of(first.kind)},
            {"words", first.words},
            {"events", incident.events.size()},
            {"pose", nullptr},
            {"revision", incident.revision},
            {"bytes", stored.bytes},
            {"pinned", stored.is_pinned},
            {"complete", incident.is_complete()},
            {"picture", has_picture(stored)}};
  if (const auto& pose = incident.map_from_robot)
    json["pose"] = {{"x_m", pose->x}, {"y_m", pose->y}, {"heading_deg", degrees(pose->theta)}};
  return json;
}

Json list_of(const std::vector<StoredIncident>& all) {
  Json list = Json::array();
  for (const StoredIncident& stored : all) list.push_back(listed(stored));
  return list;
}

std::string line(const Json& json) { return json.dump(-1, ' ', false, Json::error_handler_t::replace); }

}  // namespace

std::vector<StoredIncident> incidents_in(const fs::path& folder) {
  std::vector<StoredIncident> all;
  std::error_code error;
  for (const auto& entry : fs::directory_iterator(folder, error)) {
    std::error_code gone;
    if (entry.path().filename().string().starts_with('.') || !entry.is_directory(gone)) continue;
    try {
      all.push_back({entry.path(), read_incident(entry.path()), bytes_in(entry.path()),
                     fs::exists(entry.path() / kIncidentPin, gone)});
    } catch (const std::runtime_error&) {  // not ours
    }
  }
  std::sort(all.begin(), all.end(), [](const StoredIncident& one, const StoredIncident& other) {
    return one.incident.name < other.incident.name;
  });
  return all;
}

std::string line_of(const StoredIncident& stored) {
  char size[32];
  (void)std::snprintf(size, sizeof size, "%.1f MB", 1e-6 * static_cast<double>(stored.bytes));
  return stored.incident.name + "  " + size + "  " + place_text(stored.incident) + "  " +
         stored.incident.events.front().words + (stored.is_pinned ? "  (pinned)" : "");
}

std::string json_of(const std::vector<StoredIncident>& all) { return line(list_of(all)); }

std::string incidents_json(const fs::path& folder) {
  const auto all = folder.empty() ? std::vector<StoredIncident>{} : incidents_in(folder);
  return line({{"folder", folder.string()}, {"incidents", list_of(all)}});
}

std::string incidents_reply(const IncidentSettings& settings) {
  if (settings.folder.empty()) return line({{"ok", false}, {"error", kNothingIsKept}});
  const std::vector<StoredIncident> all = incidents_in(settings.folder);
  std::string text = counted(all.size(), "incident") + " in " + settings.folder;
  for (const StoredIncident& stored : all) text += "\n" + line_of(stored);
  return line({{"ok", true}, {"message", text}, {"incidents", list_of(all)}});
}

std::optional<std::string> words_of_incident(const fs::path& folder, std::string_view name) {
  for (const StoredIncident& stored : incidents_in(folder)) {
    if (stored.folder.filename() == name) return words_of(stored.incident, has_picture(stored));
  }
  return std::nullopt;
}

std::optional<std::string> picture_of_incident(const fs::path& folder, std::string_view name) {
  for (const StoredIncident& stored : incidents_in(folder)) {
    if (stored.folder.filename() == name && has_picture(stored)) return text_of_file(stored.folder / kIncidentPicture);
  }
  return std::nullopt;
}

}  // namespace deltamap::daemon
