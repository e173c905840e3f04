// SPDX-License-Identifier: Apache-2.0
// The incidents of a folder, for `deltamap incident`, `ctl incidents` and the live page.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "daemon/incidents/incident.hpp"
#include "daemon/settings/settings.hpp"

namespace deltamap::daemon {

struct StoredIncident {
  std::filesystem::path folder;
  Incident incident;
  std::uint64_t bytes = 0;
  bool is_pinned = false;
};
/// All incidents in a folder, oldest first; what is no incident is passed over. Empty where there is no such folder.
[[nodiscard]] std::vector<StoredIncident> incidents_in(const std::filesystem::path& folder);
/// One line of a list: "20261130T030012Z-lost  8.1 MB  at 1.20, 3.40, 90°  the pose was lost".
[[nodiscard]] std::string line_of(const StoredIncident& stored);

/// A JSON array of them: name, kind, time, words, pose, bytes, pinned, complete, picture.
[[nodiscard]] std::string json_of(const std::vector<StoredIncident>& all);
/// {"folder":…,"incidents":[…]} of a folder; both empty where none are kept.
[[nodiscard]] std::string incidents_json(const std::filesystem::path& folder);
/// A line for `deltamap ctl incidents`: {"ok":true,"message":…,"incidents":[…]}; {"ok":false,"error":…} where none are
/// kept.
[[nodiscard]] std::string incidents_reply(const IncidentSettings& settings);
/// The page in words of one; nothing where the folder holds none of that name.
[[nodiscard]] std::optional<std::string> words_of_incident(const std::filesystem::path& folder, std::string_view name);

/// Its picture, a PNG; nothing where it has none, or the folder holds none of that name. Throws std::runtime_error
/// where it cannot be read.
[[nodiscard]] std::optional<std::string> picture_of_incident(const std::filesystem::path& folder,
                                                             std::string_view name);

}  // namespace deltamap::daemon
