// SPDX-License-Identifier: Apache-2.0
// map.newest: the newest revision as a map_server map, for other programs: written at the start and with every
// revision, each file replaced in one step. Never the first map itself: run_contradictions.hpp.
#pragma once

#include <optional>
#include <string>

#include "core/files/file_lock.hpp"
#include "daemon/settings/settings.hpp"

namespace deltamap::daemon {

/// Throws StartError where map.newest names no description.
void require_newest_named(const MapSettings& map);

/// Looks at the place of map.newest. Empty, or why it cannot be written now (a read-only file system). Throws
/// StartError where only a person can mend it: as require_newest_named(), or this user may not.
[[nodiscard]] std::string judged_newest_place(const MapSettings& map);

/// For this run alone; nothing where map.newest is empty, or there can be no lock. Throws FileInUse, and StartError as
/// judged_newest_place().
[[nodiscard]] std::optional<FileLock> newest_map_lock(const MapSettings& map);

}  // namespace deltamap::daemon
