// SPDX-License-Identifier: Apache-2.0
#include "daemon/live/incident_answers.hpp"

#include <optional>
#include <string>
#include <utility>

#include "daemon/incidents/incident_list.hpp"

namespace deltamap::daemon {
namespace {

constexpr std::string_view kList = "/api/incidents";
constexpr std::string_view kPicture = "/picture.png";

}  // namespace

dashboard::Answer incidents_answer(const std::filesystem::path& folder, std::string_view path) {
  if (path == kList) return {.type = "application/json", .body = incidents_json(folder) + "\n"};
  const bool names_one = path.size() > kList.size() + 1 && path[kList.size()] == '/';
  if (names_one && !folder.empty()) {
    const std::string_view name = path.substr(kList.size() + 1);
    if (name.ends_with(kPicture)) {
      if (auto png = picture_of_incident(folder, name.substr(0, name.size() - kPicture.size())))
        return {.type = "image/png", .body = *std::move(png)};
    } else if (auto words = words_of_incident(folder, name))
      return {.type = "text/plain; charset=utf-8", .body = *std::move(words)};
  }
  return {.status = 404, .body = "no such incident\n"};
}

}  // namespace deltamap::daemon
