// SPDX-License-Identifier: Apache-2.0
// A picture in memory.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace deltamap::tool::picture {

struct Raster {
  std::size_t width = 0;
  std::size_t height = 0;
  std::vector<std::uint8_t> rgb;  ///< row by row from the top, three bytes a pixel

  friend bool operator==(const Raster&, const Raster&) = default;
};

}  // namespace deltamap::tool::picture
