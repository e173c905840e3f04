// SPDX-License-Identifier: Apache-2.0
// Why a field of distances and no ray casting: a beam's end costs one look at a byte, and its value falls off smoothly
// with the distance from a contour, so that a pose that is a little off still scores and can be pulled to the best
// one. A cast ray changes its length in jumps where it grazes an edge.
#include "localization/sensor/likelihood_field.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <cstddef>

#include "core/grid/block_lattice.hpp"
#include "core/grid/grid_contour.hpp"

namespace deltamap::localization::sensor {
namespace {

constexpr int kRowsAtOnce = 64;   // of a whole rebuild: its working memory stays small however large the map
constexpr int kContourReach = 2;  // a cell's being contour depends on cells up to two away
constexpr int kWindowStepCells = 64;

double hit_deviation_on(const GridGeometry& geometry, const LikelihoodFieldParams& params) {
  return std::max(params.hit_deviation_m, 0.7 * geometry.resolution_m);
}

std::uint8_t steps_of_likelihood(double p) {
  return static_cast<std::uint8_t>(std::clamp(std::lround(-std::log(p) / LikelihoodField::kStep), 0L, 255L));
}

/// Bytes by squared distance in cells; the last one holds for everything farther.
struct StepTable {
  int reach_cells = 0;
  std::vector<std::uint8_t> steps;  // 0 .. reach², then the farthest
  std::uint8_t unknown = 0;

  [[nodiscard]] std::uint8_t at(int distance2) const {
    return steps[static_cast<std::size_t>(std::min(distance2, static_cast<int>(steps.size()) - 1))];
  }
};

StepTable step_table(const GridGeometry& geometry, const LikelihoodFieldParams& params) {
  const double deviation_cells = hit_deviation_on(geometry, params) / geometry.resolution_m;
  const auto likelihood = [&](double distance2) {
    return (1.0 - params.random_share) * std::exp(-0.5 * distance2 / (deviation_cells * deviation_cells)) +
           params.random_share;
  };
  const std::uint8_t farthest = steps_of_likelihood(params.random_share);
  StepTable table;
  int distance2 = 0;
  for (; steps_of_likelihood(likelihood(distance2)) < farthest; ++distance2) {
    table.steps.push_back(steps_of_likelihood(likelihood(distance2)));
  }
  table.reach_cells = static_cast<int>(std::ceil(std::sqrt(static_cast<double>(distance2))));
  table.steps.push_back(farthest);
  table.unknown = std::min(farthest, steps_of_likelihood(params.unknown_likelihood));
  return table;
}

/// A single row or column of cells between unknown space: the face of a thing that stands beside another. Once one of
/// them is taken away, and not yet off the map, beams end there.
bool is_thin(const OccupancyGrid& map, Cell cell) {
  const auto is_between = [&](int columns, int rows) {
    return map.at({cell.column + columns, cell.row + rows}) != CellState::kOccupied &&
           map.at({cell.column - columns, cell.row - rows}) != CellState::kOccupied;
  };
  return is_between(1, 0) || is_between(0, 1);
}

/// The bytes of one window, in two passes: down each column the distance to the nearest contour, then along each row
/// the least sum of squares. Exact, and blind to anything farther than the reach: that makes windows equal to the
/// whole.
class WindowBuilder {
 public:
  WindowBuilder(const OccupancyGrid& map, const CellBox& window, const StepTable& table)
      : map_{map},
        table_{table},
        window_{window},
        wide_{grown(window, table.reach_cells)},
        never_{table.reach_cells + 1},
        width_{static_cast<std::size_t>(window.width()) + 2 * static_cast<std::size_t>(table.reach_cells)},
        column_distance_(width_ * static_cast<std::size_t>(window.height()), never_ * never_) {}

  [[nodiscard]] std::vector<std::uint8_t> bytes() {
    measure_columns_upwards();
    measure_columns_downwards();
    std::vector<std::uint8_t> bytes;
    bytes.reserve(window_.cell_count());
    for (int row = window_.first.row; row < window_.last.row; ++row) {
      const int* in_row = row_of_distances(row) + table_.reach_cells;
      for (int column = window_.first.column; column < window_.last.column; ++column, ++in_row) {
        const std::uint8_t steps = table_.at(squared_distance(in_row));
        const bool unknown = map_.at({column, row}) == CellState::kUnknown;
        bytes.push_back(unknown ? std::min(steps, table_.unknown) : steps);
      }
    }
    return bytes;
  }

 private:
  /// Squared distances along the columns; entry 0 belongs to the column `reach` before the window's first.
  [[nodiscard]] int* row_of_distances(int row) {
    return column_distance_.data() + static_cast<std::size_t>(row - window_.first.row) * width_;
  }
  [[nodiscard]] std::size_t entry_of(int column) const {
    const int entry = column - window_.first.column + table_.reach_cells;
    return static_cast<std::size_t>(entry);
  }

  void measure_columns_upwards() {
    std::vector<int> distance(width_, never_);
    for (int row = wide_.first.row; row < window_.last.row; ++row) {
      int* const squared = row >= window_.first.row ? row_of_distances(row) : nullptr;
      for (int column = wide_.first.column; column < wide_.last.column; ++column) {
        int& at = distance[entry_of(column)];
        at = is_contour(map_, {column, row}) ? 0 : std::min(at + 1, never_);
        if (squared != nullptr) squared[entry_of(column)] = at * at;
      }
    }
  }

  void measure_columns_downwards() {
    std::vector<int> distance(width_, never_);
    for (int row = wide_.last.row; row-- > window_.first.row;) {
      int* const squared = row < window_.last.row ? row_of_distances(row) : nullptr;
      for (int column = wide_.first.column; column < wide_.last.column; ++column) {
        int& at = distance[entry_of(column)];
        const bool contour = squared != nullptr ? squared[entry_of(column)] == 0 : is_contour(map_, {column, row});
        at = contour ? 0 : std::min(at + 1, never_);
        if (squared != nullptr) squared[entry_of(column)] = std::min(squared[entry_of(column)], at * at);
      }
    }
  }

  [[nodiscard]] int squared_distance(const int* in_row) const {
    int best = *in_row;
    for (int aside = 1; aside <= table_.reach_cells && aside * aside < best; ++aside) {
      best = std::min(best, aside * aside + std::min(in_row[-aside], in_row[aside]));
    }
    return best;
  }

  const OccupancyGrid& map_;
  const StepTable& table_;
  CellBox window_;
  CellBox wide_;  // what the window depends on
  int never_;     // farther than anything that counts, cells
  std::size_t width_;
  std::vector<int> column_distance_;
};

/// Inverse of the likelihood: what distance a byte stands for.
std::array<float, 256> distances_of_steps(const StepTable& table, double resolution_m) {
  std::array<float, 256> distances{};
  for (std::size_t steps = 0; steps < distances.size(); ++steps) {
    const auto not_nearer = std::lower_bound(table.steps.begin(), table.steps.end(), static_cast<std::uint8_t>(steps));
    const auto distance2 = static_cast<double>(std::min(not_nearer, table.steps.end() - 1) - table.steps.begin());
    distances[steps] = static_cast<float>(std::sqrt(distance2) * resolution_m);
  }
  return distances;
}

}  // namespace

bool is_contour(const OccupancyGrid& map, Cell cell) {
  if (map.at(cell) != CellState::kOccupied) return false;
  if (is_thin(map, cell)) return true;
  for (int row = cell.row - 1; row <= cell.row + 1; ++row) {
    for (int column = cell.column - 1; column <= cell.column + 1; ++column) {
      const CellState neighbour = map.at({column, row});
      if (neighbour == CellState::kFree) return true;
      if (neighbour == CellState::kUnknown && has_free_side(map, {column, row})) return true;
    }
  }
  return false;
}

LikelihoodField::LikelihoodField(const OccupancyGrid& map, const LikelihoodFieldParams& params)
    : geometry_{map.geometry()},
      params_{params},
      hit_deviation_m_{hit_deviation_on(map.geometry(), params)},
      even_steps_{static_cast<std::uint8_t>(-std::log(2.0 * params.random_share) / kStep)} {
  const StepTable table = step_table(geometry_, params);
  distance_of_steps_m_ = distances_of_steps(table, geometry_.resolution_m);
  bytes_.assign(4, table.unknown);  // the border of nothing
  const CellBox shown = grown(known_box(map), table.reach_cells);
  widen(shown);
  for (int row = shown.first.row; row < shown.last.row; row += kRowsAtOnce) {
    const CellBox band{{shown.first.column, row}, {shown.last.column, std::min(row + kRowsAtOnce, shown.last.row)}};
    apply({band, WindowBuilder{map, band, table}.bytes()});
  }
}

std::uint8_t LikelihoodField::steps_at(Cell cell) const {
  return window_.contains(cell) ? bytes_[index_of(cell)] : bytes_.front();
}

void LikelihoodField::widen(const CellBox& box) {
  if (box.empty() || (window_.contains(box.first) && window_.contains({box.last.column - 1, box.last.row - 1}))) return;
  const BlockLattice lattice{geometry_, kWindowStepCells};
  const CellBox blocks = lattice.blocks_of(united(window_, box));
  const CellBox wide{lattice.cells_of(blocks.first).first, lattice.cells_of(blocks.last).first};
  const LikelihoodField before = *this;
  window_ = wide;
  window_origin_ = geometry_.origin + geometry_.resolution_m * Point2{wide.first.column, wide.first.row};
  const Bordered size = bordered();
  bytes_.assign(static_cast<std::size_t>(size.width) * static_cast<std::size_t>(size.height), before.bytes_.front());
  for (int row = before.window_.first.row; row < before.window_.last.row; ++row) {
    const Cell first{before.window_.first.column, row};
    std::copy_n(before.bytes_.data() + before.index_of(first), before.window_.width(), bytes_.data() + index_of(first));
  }
}

void LikelihoodField::apply(const FieldPatch& patch) {
  if (patch.box.empty()) return;
  const auto patch_width = static_cast<std::size_t>(patch.box.width());
  assert(patch.values.size() == patch_width * static_cast<std::size_t>(patch.box.height()) && "a value for each cell");
  widen(patch.box);
  const std::uint8_t* from = patch.values.data();
  for (int row = patch.box.first.row; row < patch.box.last.row; ++row, from += patch_width) {
    std::copy_n(from, patch_width, bytes_.data() + index_of({patch.box.first.column, row}));
  }
}

FieldPatch field_patch(const OccupancyGrid& map, std::span<const CellChange> changes,
                       const LikelihoodFieldParams& params) {
  if (changes.empty()) return {};
  const StepTable table = step_table(map.geometry(), params);
  const CellBox window = grown(bounding_box(changes), table.reach_cells + kContourReach);
  return {window, WindowBuilder{map, window, table}.bytes()};
}

}  // namespace deltamap::localization::sensor
