// SPDX-License-Identifier: Apache-2.0
#include "core/grid/grid_contour.hpp"

#include <bit>
#include <cstdint>
#include <cstring>
#include <span>

namespace deltamap {
namespace {

static_assert(static_cast<int>(CellState::kFree) == 0 && static_cast<int>(CellState::kOccupied) == 1 &&
              static_cast<int>(CellState::kUnknown) == 2);

static_assert(std::endian::native == std::endian::little, "the first cell is the lowest byte of a word");

constexpr std::size_t kCellsOfAWord = 8;  // most hold nothing occupied
constexpr std::uint64_t kLowBits = 0x0101010101010101ULL;

std::uint64_t word_at(const CellState* cells) {
  std::uint64_t word = 0;
  std::memcpy(&word, cells, sizeof word);
  return word;
}

bool is_contour(const OccupancyGrid& map, Cell cell) {
  return map[cell] == CellState::kOccupied && has_free_side(map, cell);
}

}  // namespace

std::vector<Cell> contour_cells(const OccupancyGrid& map) { return contour_cells(map, map.box()); }

std::vector<Cell> contour_cells(const OccupancyGrid& map, const CellBox& box) {
  std::vector<Cell> contour;
  const auto is_wanted = [&](Cell cell) {
    return map.fill() == CellState::kOccupied || map.tiles().tile_at(cell) != map.tiles().background();
  };
  map.tiles().visit_where(grown(box, 0, map.geometry()), is_wanted, [&](Cell first, std::span<const CellState> cells) {
    const auto look_at = [&](std::size_t i) {
      const Cell cell{first.column + static_cast<int>(i), first.row};
      if (is_contour(map, cell)) contour.push_back(cell);
    };
    std::size_t next = 0;
    for (; next + kCellsOfAWord <= cells.size(); next += kCellsOfAWord) {
      for (std::uint64_t left = word_at(&cells[next]) & kLowBits; left != 0; left &= left - 1) {
        look_at(next + static_cast<std::size_t>(std::countr_zero(left)) / 8);
      }
    }
    for (; next < cells.size(); ++next) look_at(next);
  });
  return contour;
}

}  // namespace deltamap
