// SPDX-License-Identifier: Apache-2.0
// A drawn map as pictures of all kinds, and the keys of a map_server file beside them.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "core/grid/occupancy_grid.hpp"
#include "core/random.hpp"
#include "tests/support/files/png_bytes.hpp"

namespace deltamap::test::map_pictures {

using Bytes = std::vector<std::uint8_t>;

/// Shade of a state in a picture.
struct Shades {
  unsigned occupied = 0;
  unsigned unknown = 205;
  unsigned free = 254;
  [[nodiscard]] unsigned of(CellState state) const {
    return state == CellState::kOccupied ? occupied : state == CellState::kFree ? free : unknown;
  }
};

/// Mostly unknown, floor within, walls and posts; every state there.
inline OccupancyGrid building(int width, int height, std::uint64_t seed) {
  Random random{seed};
  OccupancyGrid grid{{width, height, 0.05, {-1.5, 2.25}}};
  for (int row = 0; row < height; ++row) {
    for (int column = 0; column < width; ++column) {
      const auto drawn = random.index_below(10);
      grid.set({column, row}, drawn < 3 ? CellState::kUnknown : drawn < 4 ? CellState::kOccupied : CellState::kFree);
    }
  }
  grid.set({0, 0}, CellState::kOccupied);
  grid.set({width - 1, height - 1}, CellState::kUnknown);
  grid.set({width / 2, height / 2}, CellState::kFree);
  return grid;
}

/// `visit(state)` for each cell of a picture, row by row from the top.
template <typename Visit, typename EndRow>
inline void visit_picture(const OccupancyGrid& grid, Visit&& visit, EndRow&& end_row) {
  for (int row = grid.height() - 1; row >= 0; --row) {
    for (int column = 0; column < grid.width(); ++column) visit(grid[Cell{column, row}]);
    end_row();
  }
}

inline std::string size_of(const OccupancyGrid& grid) {
  return std::to_string(grid.width()) + " " + std::to_string(grid.height());
}

inline std::string binary_pgm(const OccupancyGrid& grid, const Shades& shades, unsigned brightest = 255,
                              const std::string& line_end = "\n") {
  std::string bytes = "P5" + line_end + size_of(grid) + line_end + std::to_string(brightest) + line_end;
  visit_picture(
      grid,
      [&](CellState state) {
        const unsigned shade = shades.of(state);
        if (brightest > 255) bytes += static_cast<char>(shade >> 8U);
        bytes += static_cast<char>(shade & 0xFFU);
      },
      [] {});
  return bytes;
}

inline std::string text_pgm(const OccupancyGrid& grid, const Shades& shades, unsigned brightest = 255,
                            const std::string& line_end = "\n") {
  std::string bytes = "P2" + line_end + "# by hand" + line_end + size_of(grid) + line_end + std::to_string(brightest);
  visit_picture(
      grid, [&](CellState state) { bytes += line_end + std::to_string(shades.of(state)); },
      [&] { bytes += " # a row"; });
  return bytes + line_end;
}

inline std::string png(const OccupancyGrid& grid, PngPicture picture,
                       const std::function<void(CellState, Bytes&)>& add) {
  picture.width = grid.width();
  picture.height = grid.height();
  picture.rows.emplace_back();
  visit_picture(
      grid, [&](CellState state) { add(state, picture.rows.back()); }, [&] { picture.rows.emplace_back(); });
  picture.rows.pop_back();
  return png_bytes(picture);
}

inline Bytes samples(unsigned grey, std::size_t colours, int alpha = -1) {
  Bytes bytes(colours, static_cast<std::uint8_t>(grey));
  if (alpha >= 0) bytes.push_back(static_cast<std::uint8_t>(alpha));
  return bytes;
}

inline std::string png_of(const OccupancyGrid& grid, int colour_type, bool is_alpha_unknown = false,
                          bool interlaced = false) {
  const std::size_t colours = (colour_type & PNG_COLOR_MASK_COLOR) != 0 ? 3 : 1;
  const bool has_alpha = (colour_type & PNG_COLOR_MASK_ALPHA) != 0;
  return png(grid, {.colour_type = colour_type, .is_interlaced = interlaced}, [&](CellState state, Bytes& row) {
    const bool is_clear = is_alpha_unknown && state == CellState::kUnknown;
    const Bytes pixel = samples(is_clear ? 254 : Shades{}.of(state), colours, !has_alpha ? -1 : is_clear ? 0 : 255);
    row.insert(row.end(), pixel.begin(), pixel.end());
  });
}

inline std::string deep_png(const OccupancyGrid& grid) {
  return png(grid, {.depth = 16}, [](CellState state, Bytes& row) {
    row.insert(row.end(), 2, static_cast<std::uint8_t>(Shades{}.of(state)));
  });
}

/// A palette whose third colour is white, and clear where asked.
inline std::string palette_png(const OccupancyGrid& grid, bool is_alpha_unknown) {
  PngPicture picture{.colour_type = PNG_COLOR_TYPE_PALETTE, .palette = {{254, 254, 254}, {0, 0, 0}, {205, 205, 205}}};
  if (is_alpha_unknown) picture.palette_alpha = {255, 255, 0};
  return png(grid, picture, [](CellState state, Bytes& row) { row.push_back(static_cast<std::uint8_t>(state)); });
}

struct Keys {
  std::string image = "map.pgm";
  std::string origin = "[-1.5, 2.25, 0]";
  std::string negate = "0";
  std::string thresholds = "occupied_thresh: 0.65\nfree_thresh: 0.196\n";
  std::string more;
  [[nodiscard]] std::string text() const {
    return "image: " + image + "\nresolution: 0.05\norigin: " + origin + "\nnegate: " + negate + "\n" + thresholds +
           more;
  }
};

/// The picture of a map that is turned back by quarters (counterclockwise), so that its origin's yaw makes it right.
inline OccupancyGrid turned_back(const OccupancyGrid& grid, int quarters) {
  OccupancyGrid turned = grid;
  for (int i = 0; i < quarters; ++i) {
    OccupancyGrid next{{turned.height(), turned.width(), 0.05, grid.geometry().origin}};
    for (int row = 0; row < turned.height(); ++row) {
      for (int column = 0; column < turned.width(); ++column)
        next.set({row, turned.width() - 1 - column}, turned[Cell{column, row}]);
    }
    turned = next;
  }
  return turned;
}

inline std::string turned_origin(const OccupancyGrid& grid, int quarters, const std::string& yaw) {
  const double right = -1.5 + (quarters == 1 || quarters == 2 ? grid.width() * 0.05 : 0.0);
  const double top = 2.25 + (quarters >= 2 ? grid.height() * 0.05 : 0.0);
  return "[" + std::to_string(right) + ", " + std::to_string(top) + ", " + yaw + "]";
}

}  // namespace deltamap::test::map_pictures
