// SPDX-License-Identifier: Apache-2.0
#include "core/grid_contour.hpp"

#include <algorithm>
#include <bit>
#include <cstdint>
#include <cstring>

namespace deltamap {
namespace {

static_assert(static_cast<int>(CellState::kFree) == 0 && static_cast<int>(CellState::kOccupied) == 1 &&
              static_cast<int>(CellState::kUnknown) == 2);

static_assert(std::endian::native == std::endian::little, "the first cell is the lowest byte of a word");

constexpr int kTogether = 8;  // cells of one word
constexpr std::uint64_t kLowBits = 0x0101010101010101ULL;

std::uint64_t word_at(const CellState* cells) {
  std::uint64_t word = 0;
  std::memcpy(&word, cells, sizeof word);
  return word;
}

/// 1 in the byte of each free cell.
std::uint64_t free_in(std::uint64_t word) { return ~(word | word >> 1U) & kLowBits; }

bool is_contour(const OccupancyGrid& map, Cell cell) {
  if (map[cell] != CellState::kOccupied) return false;
  return map.at({cell.column + 1, cell.row}) == CellState::kFree ||
         map.at({cell.column - 1, cell.row}) == CellState::kFree ||
         map.at({cell.column, cell.row + 1}) == CellState::kFree ||
         map.at({cell.column, cell.row - 1}) == CellState::kFree;
}

}  // namespace

std::vector<Cell> contour_cells(const OccupancyGrid& map) {
  return contour_cells(map, {{0, 0}, {map.width(), map.height()}});
}

std::vector<Cell> contour_cells(const OccupancyGrid& map, const CellBox& box) {
  const CellBox part = grown(box, 0, map.geometry());
  std::vector<Cell> contour;
  for (int row = part.first.row; row < part.last.row; ++row) {
    const bool has_rows_beside = row > 0 && row + 1 < map.height();
    for (int column = part.first.column; column < part.last.column;) {
      const bool together =
          has_rows_beside && column > 0 && column + kTogether < map.width() && column + kTogether <= part.last.column;
      if (!together) {
        if (is_contour(map, {column, row})) contour.push_back({column, row});
        ++column;
        continue;
      }
      const CellState* const here = map.cells().data() + map.geometry().index_of({column, row});
      const std::uint64_t occupied = word_at(here) & kLowBits;
      if (occupied != 0) {
        std::uint64_t left = occupied & (free_in(word_at(here - 1)) | free_in(word_at(here + 1)) |
                                         free_in(word_at(here - map.width())) | free_in(word_at(here + map.width())));
        for (; left != 0; left &= left - 1) {
          const int byte = std::countr_zero(left) / 8;
          contour.push_back({column + byte, row});
        }
      }
      column += kTogether;
    }
  }
  return contour;
}

}  // namespace deltamap
