// SPDX-License-Identifier: Apache-2.0
// An incident in the page.
#pragma once

#include <cstdint>
#include <filesystem>

namespace deltamap::tool {

/// Replays it into the page until a signal comes. Port 0: any that is free. Throws std::runtime_error with one line.
void view_incident(const std::filesystem::path& folder, std::uint16_t port);

}  // namespace deltamap::tool
