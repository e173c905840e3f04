// SPDX-License-Identifier: Apache-2.0
#include "mapping/hidden_floor.hpp"

#include <algorithm>
#include <array>
#include <cstdint>
#include <unordered_map>

namespace deltamap::mapping {
namespace {

constexpr int kCrackCells = 2;
constexpr std::array<Cell, 4> kSides{{{1, 0}, {-1, 0}, {0, 1}, {0, -1}}};

class Floor {
 public:
  Floor(const OccupancyGrid& map, std::span<const Point2> robot_was, double most_m2)
      : map_{map}, most_cells_{static_cast<std::size_t>(most_m2 / (map.resolution_m() * map.resolution_m()))} {
    for (const Point2& place : robot_was) robot_was_.push_back(map.geometry().cell_at(place));
  }

  /// The whole piece of floor that the cell belongs to where it is closed off; else nothing. A piece is looked at once.
  [[nodiscard]] std::vector<Cell> closed_off_from(Cell start) {
    std::vector<Cell> piece;
    if (!enter(start, piece)) return {};
    bool is_open = false;
    for (std::size_t next = 0; next < piece.size() && !is_open; ++next) {
      const Cell cell = piece[next];
      is_open = piece.size() > most_cells_ || std::find(robot_was_.begin(), robot_was_.end(), cell) != robot_was_.end();
      for (const Cell& side : kSides) is_open |= meets_open_floor(cell, side, piece);
    }
    for (const Cell& cell : piece) open_[map_.geometry().index_of(cell)] = is_open;
    return is_open ? std::vector<Cell>{} : piece;
  }

 private:
  /// A gap of a cell or two in a line of occupied cells, which only the drawing has left.
  [[nodiscard]] bool is_crack(Cell cell) const {
    const auto gap = [&](const Cell& step) {
      for (int i = 1; i <= kCrackCells; ++i) {
        if (map_.at({cell.column + i * step.column, cell.row + i * step.row}) == CellState::kOccupied) return i;
      }
      return 2 * kCrackCells;
    };
    return gap({1, 0}) + gap({-1, 0}) <= kCrackCells + 1 || gap({0, 1}) + gap({0, -1}) <= kCrackCells + 1;
  }

  bool enter(Cell cell, std::vector<Cell>& piece) {
    if (map_.at(cell) != CellState::kFree || is_crack(cell)) return false;
    if (!open_.try_emplace(map_.geometry().index_of(cell), false).second) return false;
    piece.push_back(cell);
    return true;
  }

  /// Goes on to the cell beside; or does it belong to a piece from which the robot can be reached?
  bool meets_open_floor(Cell cell, const Cell& side, std::vector<Cell>& piece) {
    const Cell beside{cell.column + side.column, cell.row + side.row};
    if (!map_.geometry().contains(beside) || enter(beside, piece)) return false;
    const auto seen = open_.find(map_.geometry().index_of(beside));
    return seen != open_.end() && seen->second;
  }

  const OccupancyGrid& map_;
  std::size_t most_cells_;
  std::vector<Cell> robot_was_;
  std::unordered_map<std::size_t, bool> open_;  // cells that have been looked at, and whether the robot can come there
};

}  // namespace

std::vector<Cell> hidden_floor(const OccupancyGrid& map, std::span<const Cell> starts,
                               std::span<const Point2> robot_was, double most_m2) {
  Floor floor{map, robot_was, most_m2};
  std::vector<Cell> hidden;
  for (const Cell& start : starts) {
    const std::vector<Cell> piece = floor.closed_off_from(start);
    hidden.insert(hidden.end(), piece.begin(), piece.end());
  }
  return hidden;
}

}  // namespace deltamap::mapping
