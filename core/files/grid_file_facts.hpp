// SPDX-License-Identifier: Apache-2.0
// What the files of a map say of it, before it is read: a map may be larger than the memory.
#pragma once

#include <cstdint>
#include <filesystem>

#include "core/grid/grid_geometry.hpp"

namespace deltamap {

struct GridFileFacts {
  GridGeometry geometry;
  double occupied_threshold = 0.65;  ///< darker cells are occupied; [0, 1]
  double free_threshold = 0.196;     ///< lighter cells are free; [0, 1]
};

/// From the description and the head of the picture alone. Throws as read_grid() does.
[[nodiscard]] GridFileFacts grid_file_facts(const std::filesystem::path& yaml_file);

/// Cells of the tiles in which something is known: what a grid of it keeps in memory (core/grid/tiled.hpp). Reads the
/// picture row by row and keeps nothing. Throws as read_grid() does.
[[nodiscard]] std::uint64_t shown_cells(const std::filesystem::path& yaml_file);

}  // namespace deltamap
