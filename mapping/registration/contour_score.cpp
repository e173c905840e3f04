// SPDX-License-Identifier: Apache-2.0
#include "mapping/registration/contour_score.hpp"

#include <array>

#include "core/grid/tiled.hpp"
#include "mapping/registration/transformed_grid.hpp"

namespace deltamap::mapping::registration {
namespace {

constexpr std::array<Cell, 8> kCellsAround{{{1, 0}, {-1, 0}, {0, 1}, {0, -1}, {1, 1}, {-1, -1}, {1, -1}, {-1, 1}}};

double share(std::size_t part, std::size_t whole) {
  return whole == 0 ? 0.0 : static_cast<double>(part) / static_cast<double>(whole);
}

}  // namespace

double ContourScore::recall() const { return share(paired, occupied_one); }
double ContourScore::precision() const { return share(paired, occupied_other); }
double ContourScore::f1() const {
  const double sum = recall() + precision();
  return sum > 0.0 ? 2.0 * recall() * precision() / sum : 0.0;
}

ContourScore contour_score(const OccupancyGrid& one, const OccupancyGrid& other) {
  const GridGeometry& geometry = one.geometry();
  if (!(other.geometry() == geometry)) return contour_score(one, transformed_grid(other, {}, geometry));

  ContourScore score;
  Tiled<char> left{geometry.width, geometry.height, 0};  // occupied cells of the other without a partner
  for_each_known(one, [&](Cell, CellState state) { score.occupied_one += state == CellState::kOccupied ? 1 : 0; });
  for_each_known(other, [&](Cell cell, CellState state) {
    if (state != CellState::kOccupied) return;
    const bool in_one = one[cell] == CellState::kOccupied;
    score.paired += in_one ? 1 : 0;
    score.occupied_other += one[cell] != CellState::kUnknown ? 1 : 0;
    if (!in_one) left.set(cell, 1);
  });
  // Column by column, as the scoring script sorts its cells: the pairing is greedy, so the order matters.
  for (int column = 0; column < geometry.width; ++column) {
    for (int row = 0; row < geometry.height; ++row) {
      const Cell cell{column, row};
      if (one[cell] != CellState::kOccupied || other[cell] == CellState::kOccupied) continue;
      for (const Cell& step : kCellsAround) {
        const Cell beside{column + step.column, row + step.row};
        if (!geometry.contains(beside) || left[beside] == 0) continue;
        left.set(beside, 0);
        ++score.paired;
        score.occupied_other += one[beside] == CellState::kUnknown ? 1 : 0;
        break;
      }
    }
  }
  return score;
}

}  // namespace deltamap::mapping::registration
