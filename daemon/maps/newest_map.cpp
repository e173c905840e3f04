// SPDX-License-Identifier: Apache-2.0
#include "daemon/maps/newest_map.hpp"

#include <filesystem>

#include "daemon/outputs/output_place.hpp"
#include "daemon/settings/start_error.hpp"

namespace deltamap::daemon {

void require_newest_named(const MapSettings& map) {
  const std::filesystem::path yaml = map.newest;
  if (yaml.empty() || yaml.extension() == ".yaml" || yaml.extension() == ".yml") return;
  throw StartError("'map.newest' must name a description, NAME.yaml, not '" + map.newest + "'");
}

std::string judged_newest_place(const MapSettings& map) {
  require_newest_named(map);
  const std::filesystem::path yaml = map.newest;
  const std::filesystem::path picture = std::filesystem::path(yaml).replace_extension(".pgm");
  const std::string why = judged_file_place(yaml);
  return why.empty() ? judged_file_place(picture) : why;
}

std::optional<FileLock> newest_map_lock(const MapSettings& map) {
  if (map.newest.empty()) return std::nullopt;
  (void)judged_newest_place(map);
  // The lock is on the picture, because descriptions with different extensions share one picture.
  return or_start_error([&] { return lock_of_file(std::filesystem::path(map.newest).replace_extension(".pgm")); });
}

}  // namespace deltamap::daemon
