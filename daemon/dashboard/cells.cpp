// SPDX-License-Identifier: Apache-2.0
#include "daemon/dashboard/cells.hpp"

#include <algorithm>

#include "daemon/dashboard/wire.hpp"

namespace deltamap::daemon::dashboard {
namespace {

constexpr unsigned kLongestRun = 0x3FFF;

int next_cut(int cell, int last) { return std::min(last, (cell / kBoxSide + 1) * kBoxSide); }

void append_run(std::string& bytes, CellState state, unsigned length) {
  if (length == 0) return;
  append_number(bytes, static_cast<std::uint16_t>(static_cast<unsigned>(state) << 14U | length));
}

}  // namespace

std::vector<CellBox> pieces_of(const CellBox& box) {
  std::vector<CellBox> pieces;
  for (int row = box.first.row; row < box.last.row; row = next_cut(row, box.last.row)) {
    for (int column = box.first.column; column < box.last.column; column = next_cut(column, box.last.column)) {
      pieces.push_back({{column, row}, {next_cut(column, box.last.column), next_cut(row, box.last.row)}});
    }
  }
  return pieces;
}

std::string cells_message(const OccupancyGrid& grid, const CellBox& box, std::uint32_t revision) {
  std::string bytes;
  append_kind(bytes, MessageKind::kCells);
  append_number(bytes, revision);
  for (const int number : {box.first.column, box.first.row, box.width(), box.height()}) {
    append_number(bytes, static_cast<std::int32_t>(number));
  }
  CellState state = CellState::kUnknown;
  unsigned length = 0;
  for (int row = box.first.row; row < box.last.row; ++row) {
    for (int column = box.first.column; column < box.last.column; ++column) {
      const CellState next = grid[{column, row}];
      if (next != state || length == kLongestRun) {
        append_run(bytes, state, length);
        state = next;
        length = 0;
      }
      ++length;
    }
  }
  append_run(bytes, state, length);
  return bytes;
}

}  // namespace deltamap::daemon::dashboard
