// SPDX-License-Identifier: Apache-2.0
// Maps on disk as map_server writes them: a YAML file and a binary PGM beside it. Written whole or not at all.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>

#include "core/grid/occupancy_grid.hpp"

namespace deltamap {

/// Reads NAME.yaml and the image that it names. Cells are occupied above occupied_thresh, free below free_thresh, else
/// unknown. Throws std::runtime_error: one line that names the file and the place (a rotated origin is refused).
[[nodiscard]] OccupancyGrid read_grid(const std::filesystem::path& yaml_file);

/// What the files of a map say of it before it is read: a map may be larger than the memory.
struct GridFileFacts {
  GridGeometry geometry;
  double occupied_threshold;  ///< darker cells are occupied; [0, 1]
  double free_threshold;      ///< lighter cells are free; [0, 1]
};
/// From the description and the head of the picture alone. Throws as read_grid() does.
[[nodiscard]] GridFileFacts grid_file_facts(const std::filesystem::path& yaml_file);

/// Cells of the tiles in which something is known: what a grid of it keeps in memory (core/grid/tiled.hpp). Reads the
/// picture row by row and keeps nothing. Throws as read_grid() does.
[[nodiscard]] std::uint64_t shown_cells(const std::filesystem::path& yaml_file);

/// A map as CARMEN keeps it, told by the first bytes of the file (by its name where they are compressed): no map_server
/// map, and no log.
[[nodiscard]] bool is_carmen_map(const std::filesystem::path& file, std::string_view first_bytes);

/// Writes NAME.yaml and NAME.pgm (0 occupied, 205 unknown, 254 free; thresholds 0.65 and 0.196), each through a
/// temporary file that is synced and renamed: at any moment the two belong together, or, while size, place or
/// resolution change, there is no NAME.yaml. Throws std::runtime_error naming the file; where it is called NAME.pgm,
/// too.
void write_grid(const OccupancyGrid& grid, const std::filesystem::path& yaml_file);

/// The picture that a description names; where it cannot be read, the name that write_grid() would give it. A pipe is
/// not waited for.
[[nodiscard]] std::filesystem::path picture_named_in(const std::filesystem::path& yaml_file);

/// The texts of these two files, for whoever does not write them.
[[nodiscard]] std::string yaml_of(const OccupancyGrid& grid, const std::string& image);
[[nodiscard]] std::string pgm_of(const OccupancyGrid& grid);

}  // namespace deltamap
