// SPDX-License-Identifier: Apache-2.0
#include "daemon/live/incident_answers.hpp"

#include <optional>
#include <string>
#include <utility>

#include "daemon/incidents/incident_list.hpp"

namespace deltamap::daemon {
namespace {

constexpr std::string_view kList = "/api/incidents";

}  // namespace

dashboard::Answer incidents_answer(const std::filesystem::path& folder, std::string_view path) {
  if (path == kList) return {.type = "application/json", .body = incidents_json(folder) + "\n"};
  const bool names_one = path.size() > kList.size() + 1 && path[kList.size()] == '/';
  if (names_one && !folder.empty()) {
    if (auto words = words_of_incident(folder, path.substr(kList.size() + 1)))
      return {.type = "text/plain; charset=utf-8", .body = *std::move(words)};
  }
  return {.status = 404, .body = "no such incident\n"};
}

}  // namespace deltamap::daemon
