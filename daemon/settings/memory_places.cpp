// SPDX-License-Identifier: Apache-2.0
#include "daemon/settings/memory_places.hpp"

namespace deltamap::daemon {

MemoryPlaces memory_places(const std::filesystem::path& store) {
  if (store.empty()) return {};
  MemoryPlaces places{store, store, store, store, store, store};
  places.pose.replace_extension(".pose.json");
  places.stability.replace_extension(".stability");
  places.things.replace_extension(".things.jsonl");
  places.bays.replace_extension(".bays.jsonl");
  places.bays_seen.replace_extension(".bays-seen.json");
  places.saved_map.replace_extension(".saved.yaml");
  return places;
}

std::filesystem::path previous_recording(std::filesystem::path recording) {
  return recording.replace_extension(".previous" + recording.extension().string());
}

}  // namespace deltamap::daemon
