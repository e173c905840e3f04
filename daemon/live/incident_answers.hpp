// SPDX-License-Identifier: Apache-2.0
// What the page of a running daemon tells of incidents.
#pragma once

#include <filesystem>
#include <string_view>

#include "daemon/dashboard/request.hpp"

namespace deltamap::daemon {

/// /api/incidents: the list; /api/incidents/NAME: that one's page in words; /api/incidents/NAME/picture.png. 404 for
/// every other path.
[[nodiscard]] dashboard::Answer incidents_answer(const std::filesystem::path& folder, std::string_view path);

}  // namespace deltamap::daemon
