// SPDX-License-Identifier: Apache-2.0
// Opens the store of the settings at the start. One that is damaged, foreign or read-only is set aside whole, and all
// that can be had of it goes on in a new one; one that cannot be written now is tried again while the run goes on.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "daemon/maps/revision_keeper.hpp"
#include "daemon/steps/localization_step.hpp"

namespace deltamap::daemon {

struct OpenedStore {
  StoreToKeep store;                  ///< and its lock
  StartMap start;                     ///< the newest revision of this map, or M_0 itself
  std::vector<std::string> warnings;  ///< a short line each
};

/// Throws FileInUse where another program has it, StartError where only a person can mend it (the place is wrong, may
/// not be read, or cannot be locked).
[[nodiscard]] OpenedStore open_store(const std::filesystem::path& name, const OccupancyGrid& first);

/// Where a store has nothing of this first map but revisions of others: the map's file has changed. Else empty.
[[nodiscard]] std::string words_of_others(const mapping::store::MapStore& store);

}  // namespace deltamap::daemon
