// SPDX-License-Identifier: Apache-2.0
// The YAML file of a map_server map: which picture it has, and what the picture's pixels mean.
#pragma once

#include <filesystem>
#include <string>

#include "core/grid/grid_geometry.hpp"

namespace deltamap {

struct GridDescription {
  std::string image;  ///< beside the description, where it is no absolute path
  double resolution_m = 0.0;
  Point2 origin{0.0, 0.0};
  bool negate = false;
  double occupied_threshold = 0.65;  ///< [0, 1]
  double free_threshold = 0.196;     ///< [0, 1]
};

/// Throws std::runtime_error with one line that names the file, and the line in it.
[[nodiscard]] GridDescription read_grid_description(const std::filesystem::path& file);

}  // namespace deltamap
