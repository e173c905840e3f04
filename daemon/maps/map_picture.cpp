// SPDX-License-Identifier: Apache-2.0
#include "daemon/maps/map_picture.hpp"

#include <array>
#include <cstdint>
#include <vector>

#include "daemon/maps/png_bytes.hpp"

namespace deltamap::daemon {
namespace {

constexpr int kMargin_cells = 4;

// Free, occupied, unknown.
constexpr std::array<std::array<std::uint8_t, 3>, 3> kColours{{{255, 255, 255}, {24, 26, 30}, {204, 208, 213}}};

}  // namespace

std::string map_picture(const OccupancyGrid& map) {
  const CellBox known = grown(known_box(map), kMargin_cells, map.geometry());
  const CellBox box = known.empty() ? map.box() : known;
  std::vector<std::uint8_t> pixels;
  pixels.reserve(box.cell_count());
  for (int row = box.last.row; row-- > box.first.row;) {
    for (int column = box.first.column; column < box.last.column; ++column) {
      pixels.push_back(static_cast<std::uint8_t>(map[{column, row}]));
    }
  }
  return png_of(static_cast<std::size_t>(box.width()), static_cast<std::size_t>(box.height()), pixels, kColours);
}

}  // namespace deltamap::daemon
