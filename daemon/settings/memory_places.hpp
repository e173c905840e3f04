// SPDX-License-Identifier: Apache-2.0
// Where a run keeps what belongs to its store and its recording: files beside them, named after them.
#pragma once

#include <filesystem>

namespace deltamap::daemon {

/// All empty where there is no store.
struct MemoryPlaces {
  std::filesystem::path pose;       ///< NAME.pose.json
  std::filesystem::path stability;  ///< NAME.stability
  std::filesystem::path things;     ///< NAME.things.jsonl
  std::filesystem::path bays;       ///< NAME.bays.jsonl
  std::filesystem::path bays_seen;  ///< NAME.bays-seen.json
  std::filesystem::path saved_map;  ///< NAME.saved.yaml with its PGM: what `ctl save` writes
};
[[nodiscard]] MemoryPlaces memory_places(const std::filesystem::path& store);

/// Where a run keeps the recording of the run before it: NAME.previous.pcapng of NAME.pcapng.
[[nodiscard]] std::filesystem::path previous_recording(std::filesystem::path recording);

}  // namespace deltamap::daemon
