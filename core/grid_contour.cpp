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
  const auto look_at_each = [&](int row, int first, int last) {
    for (int column = first; column < last; ++column) {
      if (is_contour(map, {column, row})) contour.push_back({column, row});
    }
  };
  const int width = map.width();
  // Words whose cells have all their neighbours.
  const int first_word = std::max(part.first.column, 1);
  const int words = (std::min(part.last.column, width - 1) - first_word) / kTogether;
  for (int row = part.first.row; row < part.last.row; ++row) {
    if (row == 0 || row + 1 >= map.height() || words <= 0) {
      look_at_each(row, part.first.column, part.last.column);
      continue;
    }
    look_at_each(row, part.first.column, first_word);
    const CellState* const begin = map.cells().data() + map.geometry().index_of({first_word, row});
    const CellState* const end = begin + words * kTogether;
    for (const CellState* here = begin; here != end; here += kTogether) {
      const std::uint64_t occupied = word_at(here) & kLowBits;
      if (occupied == 0) continue;
      std::uint64_t left = occupied & (free_in(word_at(here - 1)) | free_in(word_at(here + 1)) |
                                       free_in(word_at(here - width)) | free_in(word_at(here + width)));
      for (; left != 0; left &= left - 1) {
        contour.push_back({first_word + static_cast<int>(here - begin) + std::countr_zero(left) / 8, row});
      }
    }
    look_at_each(row, first_word + words * kTogether, part.last.column);
  }
  return contour;
}

}  // namespace deltamap
