// SPDX-License-Identifier: Apache-2.0
#include "simulation/score/map_score.hpp"

#include <array>
#include <limits>
#include <vector>

namespace deltamap::simulation::score {
namespace {

constexpr std::array<Cell, 8> kAround{{{1, 0}, {-1, 0}, {0, 1}, {0, -1}, {1, 1}, {-1, -1}, {1, -1}, {-1, 1}}};

struct Pairs {
  CellMask of_truth;
  CellMask of_map;
  std::size_t count = 0;
  std::size_t truth_cells = 0;
  std::size_t map_cells = 0;
};

/// A surface that runs aslant goes through more cells than a line of cells that touch corner to corner: those that it
/// only clips. Of two beside each other one is left. The corner of a thing is none: its faces go on both ways.
CellMask clipped(const OccupancyGrid& truth) {
  CellMask clipped(truth.geometry().cell_count(), 0);
  const auto is_surface = [&](Cell cell) { return truth.at(cell) == CellState::kOccupied; };
  const auto is_left = [&](Cell cell) { return is_surface(cell) && clipped[truth.geometry().index_of(cell)] == 0; };
  for_each_known(truth, [&](Cell cell, CellState state) {
    if (state != CellState::kOccupied) return;
    const auto beside = [&](int columns, int rows) { return Cell{cell.column + columns, cell.row + rows}; };
    const int left = is_left(beside(-1, 0)) ? -1 : 0;
    const int right = is_left(beside(1, 0)) ? 1 : 0;
    const int below = is_left(beside(0, -1)) ? -1 : 0;
    const int above = is_left(beside(0, 1)) ? 1 : 0;
    const bool turns = right - left == 1 && above - below == 1;
    const bool is_corner = is_surface(beside(2 * (left + right), 0)) && is_surface(beside(0, 2 * (below + above)));
    if (turns && !is_corner) clipped[truth.geometry().index_of(cell)] = 1;
  });
  return clipped;
}

/// Of the truth's cells those of `optional` need not be paired.
Pairs paired(const OccupancyGrid& truth, const OccupancyGrid& map, const CellMask& where, const CellMask& optional) {
  const GridGeometry& geometry = truth.geometry();
  const std::size_t cells = geometry.cell_count();
  Pairs pairs{CellMask(cells, 0), CellMask(cells, 0)};
  const std::vector<CellState> is = all_cells(truth);
  const std::vector<CellState> said = all_cells(map);
  const auto pair = [&](std::size_t of_truth, std::size_t of_map) {
    pairs.of_truth[of_truth] = pairs.of_map[of_map] = 1;
    ++pairs.count;
    pairs.truth_cells += optional[of_truth];
    // What cannot be seen cannot be wrong, but may be the neighbour of what can.
    pairs.map_cells += is[of_map] == CellState::kUnknown ? 1 : 0;
  };
  for (std::size_t i = 0; i < cells; ++i) {
    if (where[i] == 0) continue;
    pairs.truth_cells += is[i] == CellState::kOccupied && optional[i] == 0 ? 1 : 0;
    pairs.map_cells += said[i] == CellState::kOccupied && is[i] != CellState::kUnknown ? 1 : 0;
  }
  const auto is_open = [&](std::size_t i) {
    return where[i] != 0 && said[i] == CellState::kOccupied && pairs.of_map[i] == 0;
  };
  for (const int pass : {0, 1}) {  // what need not be drawn takes nothing from what must
    const auto is_due = [&](std::size_t i) {
      return where[i] != 0 && is[i] == CellState::kOccupied && optional[i] == pass && pairs.of_truth[i] == 0;
    };
    for (std::size_t i = 0; i < cells; ++i) {
      if (is_due(i) && is_open(i)) pair(i, i);
    }
    for (std::size_t i = 0; i < cells; ++i) {
      if (!is_due(i)) continue;
      const Cell cell = geometry.cell_of(i);
      for (const Cell& step : kAround) {
        const Cell beside{cell.column + step.column, cell.row + step.row};
        if (!geometry.contains(beside) || !is_open(geometry.index_of(beside))) continue;
        pair(i, geometry.index_of(beside));
        break;
      }
    }
  }
  return pairs;
}

}  // namespace

MapScore map_score(const OccupancyGrid& truth, const OccupancyGrid& map, const CellMask& where) {
  const Pairs pairs = paired(truth, map, where, clipped(truth));
  MapScore score;
  const auto both = static_cast<double>(pairs.truth_cells + pairs.map_cells);
  score.contour_f1 = both == 0.0 ? 1.0 : 2.0 * static_cast<double>(pairs.count) / both;
  std::size_t agreeing = 0;
  std::size_t disagreeing = 0;
  std::size_t wrong = 0;
  for (std::size_t i = 0; i < where.size(); ++i) {
    if (where[i] == 0) continue;
    const Cell cell = truth.geometry().cell_of(i);
    const CellState is = truth[cell];
    const CellState said = map[cell];
    if (is == CellState::kUnknown || said == CellState::kUnknown) continue;
    ++(is == said ? agreeing : disagreeing);
    if (is == said) continue;
    const bool explained = is == CellState::kOccupied ? pairs.of_truth[i] != 0 : pairs.of_map[i] != 0;
    wrong += explained ? 0 : 1;
  }
  if (agreeing > 0) score.acceptance = static_cast<double>(agreeing) / static_cast<double>(agreeing + disagreeing);
  score.wrong_m2 = static_cast<double>(wrong) * truth.resolution_m() * truth.resolution_m();
  return score;
}

double skill(double ours, double stale, double perfect) {
  if (perfect <= stale) return std::numeric_limits<double>::quiet_NaN();
  return (ours - stale) / (perfect - stale);
}

double share_kept(const OccupancyGrid& first, const OccupancyGrid& map, const CellMask& these) {
  OccupancyGrid lasting{first.geometry()};
  std::size_t all = 0;
  for (std::size_t i = 0; i < these.size(); ++i) {
    const Cell cell = first.geometry().cell_of(i);
    if (these[i] == 0 || first[cell] != CellState::kOccupied) continue;
    lasting.set(cell, CellState::kOccupied);
    ++all;
  }
  if (all == 0) return std::numeric_limits<double>::quiet_NaN();
  const Pairs pairs = paired(lasting, map, CellMask(these.size(), 1), CellMask(these.size(), 0));
  return static_cast<double>(pairs.count) / static_cast<double>(all);
}

CellMask grown(const CellMask& mask, const GridGeometry& geometry) {
  CellMask wide = mask;
  for (std::size_t i = 0; i < mask.size(); ++i) {
    if (mask[i] == 0) continue;
    const Cell cell = geometry.cell_of(i);
    for (const Cell& step : kAround) {
      const Cell beside{cell.column + step.column, cell.row + step.row};
      if (geometry.contains(beside)) wide[geometry.index_of(beside)] = 1;
    }
  }
  return wide;
}

}  // namespace deltamap::simulation::score
