// SPDX-License-Identifier: Apache-2.0
// What the shades of a map's picture mean: free, occupied or unknown, by the thresholds of its description; and where
// shades and thresholds contradict each other.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "core/files/grid_description.hpp"
#include "core/files/picture_reader.hpp"
#include "core/grid/occupancy_grid.hpp"

namespace deltamap {

/// How many pixels of a picture have each shade; the last is transparent.
struct ShadeCensus {
  Shade brightest = 255;
  std::vector<std::uint64_t> pixels;
  std::vector<std::uint64_t> edge;  ///< of these, the outermost ones
};

/// Reads the picture to its end.
[[nodiscard]] ShadeCensus census_of(PictureReader& picture);

/// By shade. Cells are occupied above occupied_thresh, free below free_thresh, else unknown, and transparent ones are
/// unknown. A picture that has only map_saver's shades 0, 205 and 254 is read as what they mean, whatever the
/// thresholds.
[[nodiscard]] std::vector<CellState> states_of(const ShadeCensus& census, const GridDescription& keys);

/// One line for each contradiction, with the line of the description: "line 7: …".
[[nodiscard]] std::vector<std::string> doubts_of(const ShadeCensus& census, const GridDescription& keys);

}  // namespace deltamap
