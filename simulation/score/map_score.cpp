// SPDX-License-Identifier: Apache-2.0
#include "simulation/score/map_score.hpp"

#include <array>
#include <limits>
#include <utility>
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

/// Pairs occupied cells of a map with those of the truth, one with one. Of the truth's cells those of `optional` need
/// not be paired.
class Pairing {
 public:
  Pairing(const OccupancyGrid& truth, const OccupancyGrid& map, const CellMask& where, const CellMask& optional)
      : geometry_{truth.geometry()},
        is_{all_cells(truth)},
        said_{all_cells(map)},
        where_{where},
        optional_{optional},
        pairs_{CellMask(geometry_.cell_count(), 0), CellMask(geometry_.cell_count(), 0)} {}

  [[nodiscard]] Pairs pairs() && {
    count_cells();
    for (const int pass : {0, 1}) {  // what need not be drawn takes nothing from what must
      pair_in_place(pass);
      pair_beside(pass);
    }
    return std::move(pairs_);
  }

 private:
  void count_cells() {
    for (std::size_t i = 0; i < geometry_.cell_count(); ++i) {
      if (where_[i] == 0) continue;
      pairs_.truth_cells += is_[i] == CellState::kOccupied && optional_[i] == 0 ? 1 : 0;
      pairs_.map_cells += said_[i] == CellState::kOccupied && is_[i] != CellState::kUnknown ? 1 : 0;
    }
  }

  void pair_in_place(int pass) {
    for (std::size_t i = 0; i < geometry_.cell_count(); ++i) {
      if (is_due(i, pass) && is_open(i)) pair(i, i);
    }
  }

  void pair_beside(int pass) {
    for (std::size_t i = 0; i < geometry_.cell_count(); ++i) {
      if (!is_due(i, pass)) continue;
      const Cell cell = geometry_.cell_of(i);
      for (const Cell& step : kAround) {
        const Cell beside{cell.column + step.column, cell.row + step.row};
        if (!geometry_.contains(beside) || !is_open(geometry_.index_of(beside))) continue;
        pair(i, geometry_.index_of(beside));
        break;
      }
    }
  }

  /// A cell of the truth that is to be paired in this pass.
  [[nodiscard]] bool is_due(std::size_t i, int pass) const {
    return where_[i] != 0 && is_[i] == CellState::kOccupied && optional_[i] == pass && pairs_.of_truth[i] == 0;
  }
  /// A cell of the map that no other is paired with.
  [[nodiscard]] bool is_open(std::size_t i) const {
    return where_[i] != 0 && said_[i] == CellState::kOccupied && pairs_.of_map[i] == 0;
  }

  void pair(std::size_t of_truth, std::size_t of_map) {
    pairs_.of_truth[of_truth] = pairs_.of_map[of_map] = 1;
    ++pairs_.count;
    pairs_.truth_cells += optional_[of_truth];
    // What cannot be seen cannot be wrong, but may be the neighbour of what can.
    pairs_.map_cells += is_[of_map] == CellState::kUnknown ? 1 : 0;
  }

  GridGeometry geometry_;
  std::vector<CellState> is_;
  std::vector<CellState> said_;
  const CellMask& where_;
  const CellMask& optional_;
  Pairs pairs_;
};

}  // namespace

MapScore map_score(const OccupancyGrid& truth, const OccupancyGrid& map, const CellMask& where) {
  const CellMask optional = clipped(truth);
  const Pairs pairs = Pairing{truth, map, where, optional}.pairs();
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
  const CellMask everywhere(these.size(), 1);
  const CellMask none(these.size(), 0);
  const Pairs pairs = Pairing{lasting, map, everywhere, none}.pairs();
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
