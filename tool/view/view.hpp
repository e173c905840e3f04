// SPDX-License-Identifier: Apache-2.0
// An incident as a replay, and in the page.
#pragma once

#include <cstdint>
#include <filesystem>

#include "daemon/replay/replay_run.hpp"

namespace deltamap::tool {

/// With the incident's own recording, map and settings, and no `out`. Throws std::runtime_error with one line.
[[nodiscard]] daemon::ReplayJob incident_job(const std::filesystem::path& folder);

/// Replays it into the page until a signal comes. Port 0: any that is free. Throws std::runtime_error with one line.
void view_incident(const std::filesystem::path& folder, std::uint16_t port);

}  // namespace deltamap::tool
