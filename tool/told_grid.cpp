// SPDX-License-Identifier: Apache-2.0
#include "tool/told_grid.hpp"

#include <iostream>
#include <utility>

#include "core/files/grid_file.hpp"

namespace deltamap::tool {

OccupancyGrid told_grid(const std::filesystem::path& yaml_file) {
  GridWithNotes read = read_grid_with_notes(yaml_file);
  for (const std::string& note : read.notes) std::cerr << "deltamap: warning: " << note << '\n';
  return std::move(read.grid);
}

}  // namespace deltamap::tool
