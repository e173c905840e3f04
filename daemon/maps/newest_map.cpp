// SPDX-License-Identifier: Apache-2.0
#include "daemon/maps/newest_map.hpp"

#include <filesystem>
#include <system_error>
#include <vector>

#include "core/grid_file.hpp"
#include "daemon/outputs/output_place.hpp"
#include "daemon/settings/start_error.hpp"

namespace deltamap::daemon {
namespace {

namespace fs = std::filesystem;

/// The same file, by whatever name; one that is not there yet is compared by its name.
bool is_same(const fs::path& one, const fs::path& other) {
  std::error_code error;
  if (fs::equivalent(one, other, error)) return true;
  return fs::weakly_canonical(one, error) == fs::weakly_canonical(other, error);
}

/// Description and picture; where it cannot be read, its reader says why.
std::vector<fs::path> files_of_first_map(const fs::path& yaml) {
  std::vector<fs::path> files{yaml};
  try {
    files.push_back(picture_of(yaml));
  } catch (const std::runtime_error&) {
    files.push_back(fs::path(yaml).replace_extension(".pgm"));
  }
  return files;
}

}  // namespace

std::string judged_newest_place(const MapSettings& map) {
  const fs::path yaml = map.newest;
  if (yaml.extension() != ".yaml" && yaml.extension() != ".yml") {
    throw StartError("'map.newest' must name a description, NAME.yaml, not '" + map.newest + "'");
  }
  const fs::path picture = fs::path(yaml).replace_extension(".pgm");
  for (const fs::path& first : files_of_first_map(map.file)) {
    for (const fs::path& written : {yaml, picture}) {
      if (is_same(first, written)) {
        throw StartError(written.string() + ": 'map.newest' would overwrite the first map; give another name");
      }
    }
  }
  const std::string why = judged_file_place(yaml);
  return why.empty() ? judged_file_place(picture) : why;
}

std::optional<FileLock> newest_map_lock(const MapSettings& map) {
  if (map.newest.empty()) return std::nullopt;
  (void)judged_newest_place(map);
  return or_start_error([&] { return lock_of_file(map.newest); });
}

}  // namespace deltamap::daemon
