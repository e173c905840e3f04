// SPDX-License-Identifier: Apache-2.0
#include "mapping/hidden_floor.hpp"

#include <algorithm>
#include <array>
#include <cstdlib>
#include <unordered_map>

namespace deltamap::mapping {
namespace {

constexpr int kCrackCells = 2;

class Floor {
 public:
  Floor(const OccupancyGrid& map, std::span<const Point2> robot_was, double most_m2)
      : map_{map}, most_cells_{static_cast<std::size_t>(most_m2 / (map.resolution_m() * map.resolution_m()))} {
    for (const Point2& place : robot_was) {
      const Cell cell = map.geometry().cell_at(place);
      if (!is_floor(cell)) continue;
      robot_was_.push_back(cell);
      open_[map.geometry().index_of(cell)] = true;
    }
  }

  /// The whole piece of floor that the cell belongs to where it is closed off; else nothing. A piece is looked at once.
  [[nodiscard]] std::vector<Cell> closed_off_from(Cell start) {
    std::vector<Cell> piece;
    if (!enter(start, piece)) return {};
    const Cell goal = nearest_place_of_robot(start);
    std::vector<Cell> edge{start};  // to be gone on from, the last one first
    bool is_open = false;
    while (!edge.empty() && !is_open) {
      const Cell cell = edge.back();
      edge.pop_back();
      is_open = piece.size() > most_cells_;
      for (const Cell& side : sides_towards({goal.column - cell.column, goal.row - cell.row})) {
        const Cell beside{cell.column + side.column, cell.row + side.row};
        is_open |= is_known_open(beside);
        if (enter(beside, piece)) edge.push_back(beside);
      }
    }
    for (const Cell& cell : piece) open_[map_.geometry().index_of(cell)] = is_open;
    return is_open ? std::vector<Cell>{} : piece;
  }

 private:
  /// The sides of a cell, those that lead away first: what is entered last is gone on from first, so that the robot is
  /// reached in about as many cells as it is away.
  [[nodiscard]] static std::array<Cell, 4> sides_towards(Cell way) {
    const Cell along{way.column < 0 ? -1 : 1, 0};
    const Cell up{0, way.row < 0 ? -1 : 1};
    const bool is_flat = std::abs(way.column) > std::abs(way.row);
    const Cell& first = is_flat ? along : up;
    const Cell& second = is_flat ? up : along;
    return {{{-first.column, -first.row}, {-second.column, -second.row}, second, first}};
  }

  [[nodiscard]] Cell nearest_place_of_robot(Cell cell) const {
    const auto distance = [&](const Cell& place) {
      return std::abs(place.column - cell.column) + std::abs(place.row - cell.row);
    };
    const auto nearest = std::min_element(robot_was_.begin(), robot_was_.end(),
                                          [&](const Cell& a, const Cell& b) { return distance(a) < distance(b); });
    return nearest == robot_was_.end() ? cell : *nearest;
  }

  [[nodiscard]] bool is_floor(Cell cell) const { return map_.at(cell) == CellState::kFree && !is_crack(cell); }

  /// Does the cell belong to a piece from which the robot can be reached?
  [[nodiscard]] bool is_known_open(Cell cell) const {
    if (!map_.geometry().contains(cell)) return false;
    const auto seen = open_.find(map_.geometry().index_of(cell));
    return seen != open_.end() && seen->second;
  }

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
    if (map_.at(cell) != CellState::kFree) return false;
    const std::size_t index = map_.geometry().index_of(cell);
    if (open_.contains(index) || is_crack(cell)) return false;
    open_[index] = false;
    piece.push_back(cell);
    return true;
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
