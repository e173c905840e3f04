// SPDX-License-Identifier: Apache-2.0
// Maps recorded by others, where DELTAMAP_DATA (by default shared/data beside the project) holds them.
#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "core/files/grid_file.hpp"
#include "tests/support/files/source_tree.hpp"
#include "tests/support/files/temporary_folder.hpp"

namespace deltamap::test {

/// maps/NAME.yaml with its image, unpacked where it is compressed; nothing where it is missing.
inline std::optional<OccupancyGrid> recorded_map(const std::string& name) {
  const std::filesystem::path maps = data_folder() / "maps";
  const std::filesystem::path yaml = maps / (name + ".yaml");
  if (!std::filesystem::exists(yaml)) return std::nullopt;
  if (std::filesystem::exists(maps / (name + ".pgm"))) return read_grid(yaml);
  const TemporaryFolder unpacked;
  std::filesystem::copy_file(yaml, unpacked.path() / (name + ".yaml"));
  const std::string command =
      "xz -dc '" + (maps / (name + ".pgm.xz")).string() + "' > '" + (unpacked.path() / (name + ".pgm")).string() + "'";
  if (std::system(command.c_str()) != 0) return std::nullopt;
  return read_grid(unpacked.path() / (name + ".yaml"));
}

}  // namespace deltamap::test
