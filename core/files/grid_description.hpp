// SPDX-License-Identifier: Apache-2.0
// The YAML file of a map_server map: which picture it has, and what the picture's pixels mean.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "core/grid/grid_geometry.hpp"

namespace deltamap {

struct GridDescription {
  std::filesystem::path picture;  ///< as named, or, where that is not here, the one of its name beside the description
  double resolution_m = 0.0;
  Point2 origin{0.0, 0.0};  ///< lower left corner of the picture, m, map frame
  double yaw_rad = 0.0;     ///< of the picture about that corner, counterclockwise
  bool negate = false;
  double occupied_threshold = 0.65;  ///< [0, 1]
  double free_threshold = 0.196;     ///< [0, 1]

  /// Lines of the keys, from 1; 0 where a key is not given.
  struct Lines {
    int image = 0;
    int origin = 0;
    int negate = 0;
    int occupied_threshold = 0;
    int free_threshold = 0;
  };
  Lines lines;
  std::vector<std::string> notes;  ///< what was guessed or not understood, one line each, that begins with the file
};

/// Throws std::runtime_error with one line that names the file, and the line in it.
[[nodiscard]] GridDescription read_grid_description(const std::filesystem::path& file);

}  // namespace deltamap
