// SPDX-License-Identifier: Apache-2.0
// Opens the store of the settings at the start. One that is damaged, foreign or read-only is set aside whole, and all
// that can be had of it goes on in a new one; one that cannot be written now is tried again while the run goes on. The
// pose that was kept beside it tells of revisions that are no longer there.
#pragma once

#include <cstdint>
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

/// The newest revision of this first map that the pose beside the store tells of; 0: none.
[[nodiscard]] std::uint32_t known_revision(const std::filesystem::path& store, const OccupancyGrid& first);
/// Where the store ends before it: "its newest revision of this map is 50, and …: 51 to 103 are missing". Else empty.
[[nodiscard]] std::string words_of_missing(std::uint32_t newest, std::uint32_t known);
/// The file is empty, and was not: a log lies beside it, or revisions of it are known. One that is new is empty, too.
[[nodiscard]] bool was_emptied(const std::filesystem::path& store, std::uint32_t known);

/// Where a store has nothing of this first map but revisions of others: the map's file has changed. Else empty.
[[nodiscard]] std::string words_of_others(const mapping::store::MapStore& store);

}  // namespace deltamap::daemon
