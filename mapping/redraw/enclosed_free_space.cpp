// SPDX-License-Identifier: Apache-2.0
#include "mapping/redraw/enclosed_free_space.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <numbers>
#include <unordered_map>
#include <utility>

namespace deltamap::mapping::redraw {
namespace {

constexpr double kCrack_m = 0.25;  // narrower is no way in
constexpr int kLeastCrackCells = 2;
constexpr std::array<Cell, 4> kSides{{{1, 0}, {-1, 0}, {0, 1}, {0, -1}}};

class Floor {
 public:
  Floor(const OccupancyGrid& map, std::span<const Point2> robot_was, double most_m2)
      : map_{map},
        most_cells_{static_cast<std::size_t>(most_m2 / (map.resolution_m() * map.resolution_m()))},
        crack_cells_{std::max(kLeastCrackCells, static_cast<int>(std::lround(kCrack_m / map.resolution_m())))},
        slanting_cells_{static_cast<int>(crack_cells_ / std::numbers::sqrt2)} {
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
    return is_open ? std::vector<Cell>{} : with_cracks(std::move(piece));
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

  /// In a gap too narrow to be a way, between occupied cells on a line: faces that only the drawing has left open, and
  /// corners that no beam has met.
  [[nodiscard]] bool is_crack(Cell cell) const {
    const auto steps_to_occupied = [&](const Cell& step, int most) {
      for (int steps = 1; steps <= most; ++steps) {
        if (map_.at({cell.column + steps * step.column, cell.row + steps * step.row}) == CellState::kOccupied)
          return steps;
      }
      return most + 1;
    };
    const auto is_narrow = [&](const Cell& line, int most) {
      const int steps = steps_to_occupied(line, most);
      const int room = most + 1 - steps;
      return room > 0 && steps_to_occupied({-line.column, -line.row}, room) <= room;
    };
    return is_narrow({1, 0}, crack_cells_) || is_narrow({0, 1}, crack_cells_) || is_narrow({1, 1}, slanting_cells_) ||
           is_narrow({1, -1}, slanting_cells_);
  }

  /// With the corners that are too narrow to be entered.
  [[nodiscard]] std::vector<Cell> with_cracks(std::vector<Cell> piece) {
    for (std::size_t next = 0; next < piece.size(); ++next) {
      for (const Cell& side : kSides) {
        const Cell beside{piece[next].column + side.column, piece[next].row + side.row};
        if (map_.at(beside) != CellState::kFree || !is_crack(beside)) continue;
        if (open_.emplace(map_.geometry().index_of(beside), false).second) piece.push_back(beside);
      }
    }
    return piece;
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
  int crack_cells_;     // free cells of a crack along a row or column
  int slanting_cells_;  // along a diagonal
  std::vector<Cell> robot_was_;
  std::unordered_map<std::size_t, bool> open_;  // cells that have been looked at, and whether the robot can come there
};

}  // namespace

std::vector<Cell> enclosed_free_space(const OccupancyGrid& map, std::span<const Cell> starts,
                                      std::span<const Point2> robot_was, double most_m2) {
  Floor floor{map, robot_was, most_m2};
  std::vector<Cell> hidden;
  for (const Cell& start : starts) {
    const std::vector<Cell> piece = floor.closed_off_from(start);
    hidden.insert(hidden.end(), piece.begin(), piece.end());
  }
  return hidden;
}

}  // namespace deltamap::mapping::redraw
