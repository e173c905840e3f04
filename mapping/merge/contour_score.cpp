// SPDX-License-Identifier: Apache-2.0
#include "mapping/merge/contour_score.hpp"

#include <array>
#include <vector>

#include "mapping/merge/transformed_grid.hpp"

namespace deltamap::mapping::merge {
namespace {

constexpr std::array<Cell, 8> kAround{{{1, 0}, {-1, 0}, {0, 1}, {0, -1}, {1, 1}, {-1, -1}, {1, -1}, {-1, 1}}};

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
  std::vector<char> left(geometry.cell_count(), 0);  // occupied cells of the other without a partner
  for (std::size_t i = 0; i < left.size(); ++i) {
    const bool in_one = one.cells()[i] == CellState::kOccupied;
    const bool in_other = other.cells()[i] == CellState::kOccupied;
    score.occupied_one += in_one ? 1 : 0;
    score.paired += in_one && in_other ? 1 : 0;
    score.occupied_other += in_other && one.cells()[i] != CellState::kUnknown ? 1 : 0;
    left[i] = in_other && !in_one ? 1 : 0;
  }
  // Column by column, as the scoring script sorts its cells: the pairing is greedy, so the order matters.
  for (int column = 0; column < geometry.width; ++column) {
    for (int row = 0; row < geometry.height; ++row) {
      const Cell cell{column, row};
      if (one[cell] != CellState::kOccupied || other[cell] == CellState::kOccupied) continue;
      for (const Cell& step : kAround) {
        const Cell beside{column + step.column, row + step.row};
        if (!geometry.contains(beside) || left[geometry.index_of(beside)] == 0) continue;
        left[geometry.index_of(beside)] = 0;
        ++score.paired;
        score.occupied_other += one[beside] == CellState::kUnknown ? 1 : 0;
        break;
      }
    }
  }
  return score;
}

}  // namespace deltamap::mapping::merge
