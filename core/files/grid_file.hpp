// SPDX-License-Identifier: Apache-2.0
// Maps on disk as map_server has them: a YAML file and a picture beside it. Written as a binary PGM, whole or not at
// all.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "core/grid/occupancy_grid.hpp"

namespace deltamap {

/// Reads NAME.yaml and the picture that it names: PGM or PNG (core/pictures), quarter turns of the origin included.
/// What its shades mean: core/files/grid_shades.hpp. Throws std::runtime_error: one line that names the file and the
/// place.
[[nodiscard]] OccupancyGrid read_grid(const std::filesystem::path& yaml_file);

struct GridWithNotes {
  OccupancyGrid grid;
  std::vector<std::string> notes;  ///< what was guessed, left out or contradicts itself: one line each, with the file
};
/// As read_grid(), with what a person should be told.
[[nodiscard]] GridWithNotes read_grid_with_notes(const std::filesystem::path& yaml_file);

/// From the description and the head of the picture alone: a map may be larger than the memory. Throws as read_grid().
[[nodiscard]] GridGeometry grid_file_geometry(const std::filesystem::path& yaml_file);

/// Cells of the tiles in which something is known: what a grid of it keeps in memory (core/grid/tiled.hpp). Reads the
/// picture row by row and keeps nothing. Throws as read_grid() does.
[[nodiscard]] std::uint64_t shown_cells(const std::filesystem::path& yaml_file);

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
