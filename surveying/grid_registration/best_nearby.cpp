// SPDX-License-Identifier: Apache-2.0
#include "surveying/grid_registration/best_nearby.hpp"

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <vector>

#include "surveying/grid_registration/motion_equations.hpp"

namespace deltamap::surveying::grid_registration {
namespace {

constexpr std::size_t kMostPlaces = 128;  // of a shift
constexpr int kHalvings = 2;              // of the turn's step
constexpr std::size_t kParted = 2;        // turns beside which the step is halved

/// Cells counted for Eq. 11, both numbers in one: those that agree in the upper half, those known in both in the lower.
using Counts = std::int64_t;
constexpr Counts kKnown = 1;
constexpr Counts kAgrees = (Counts{1} << 32) + kKnown;
constexpr std::array<std::array<Counts, 3>, 3> kCounts{{{kAgrees, kKnown, 0}, {kKnown, kAgrees, 0}, {0, 0, 0}}};

double known_in(Counts counts) { return static_cast<double>(static_cast<std::int32_t>(counts)); }
double agreeing_in(Counts counts) {
  return static_cast<double>((counts - static_cast<std::int32_t>(counts)) / (Counts{1} << 32));
}

/// An edge cell passes from one cell of the map into the next, along one axis.
struct Crossing {
  float at_cells = 0.0F;  ///< beyond this shift it lies in the cell with the higher index; before any turn
  float per_turn = 0.0F;  ///< how far a turn, in cells at the lever arm, takes it the same way
  Counts gain = 0;        ///< of the shifts beyond
};

struct Crossings {
  std::vector<Crossing> all;
  Counts before = 0;  ///< gain over the start of a shift that lies before all of them
};

/// All cells that may cross near a pose.
struct CellsNearBorders {
  Crossings x;
  Crossings y;
  Counts at_start = 0;
};

CellsNearBorders cells_near_borders(const OccupancyGrid& map, std::span<const EdgeCell> edges,
                                    const mapping::merge::CellMotion& start, double lever_cells, double reach_cells) {
  const auto c = static_cast<float>(std::cos(start.turn_rad));
  const auto s = static_cast<float>(std::sin(start.turn_rad));
  const auto tx = static_cast<float>(start.column);
  const auto ty = static_cast<float>(start.row);
  const auto per_lever = static_cast<float>(1.0 / lever_cells);
  const auto reach = static_cast<float>(reach_cells);
  const auto most_x = static_cast<float>(map.width() - 1);
  const auto most_y = static_cast<float>(map.height() - 1);
  CellsNearBorders near;
  near.x.all.reserve(edges.size());
  near.y.all.reserve(edges.size());
  for (const EdgeCell& edge : edges) {
    const float arm_x = c * edge.at.x - s * edge.at.y;
    const float arm_y = s * edge.at.x + c * edge.at.y;
    const float x = arm_x + tx;
    const float y = arm_y + ty;
    if (!(x >= 1.0F && y >= 1.0F && x < most_x && y < most_y)) continue;
    const auto column = static_cast<std::int32_t>(x);
    const auto row = static_cast<std::int32_t>(y);
    const CellState here = map[{column, row}];
    const auto& counts = kCounts[static_cast<std::size_t>(edge.state)];
    const Counts counts_here = counts[static_cast<std::size_t>(here)];
    near.at_start += counts_here;
    const auto add = [&](Crossings& crossings, float in_cell, float per_turn, const Cell& before, const Cell& after) {
      const float farthest = reach + reach * std::abs(per_turn);
      if (in_cell <= farthest && map[before] != here) {
        const Counts gain = counts_here - counts[static_cast<std::size_t>(map[before])];
        crossings.all.push_back({-in_cell, per_turn, gain});
        crossings.before -= gain;
      }
      if (1.0F - in_cell <= farthest && map[after] != here) {
        const Counts gain = counts[static_cast<std::size_t>(map[after])] - counts_here;
        crossings.all.push_back({1.0F - in_cell, per_turn, gain});
      }
    };
    add(near.x, x - static_cast<float>(column), -arm_y * per_lever, {column - 1, row}, {column + 1, row});
    add(near.y, y - static_cast<float>(row), arm_x * per_lever, {column, row - 1}, {column, row + 1});
  }
  return near;
}

struct BestShift {
  double shift_cells = 0.0;
  double gain = -std::numeric_limits<double>::infinity();  ///< cells that agree, and what is known less
};

/// Along one axis, after a turn. What is best over a stretch is answered by its middle.
BestShift best_shift(const Crossings& crossings, double turn_cells, double acceptance, const BestNearbyParams& params) {
  const int half = static_cast<int>(std::lround(params.reach_cells / params.shift_step_cells));
  const int places = 2 * half + 1;
  assert(static_cast<std::size_t>(places) < kMostPlaces && "the step is too fine for the reach");
  std::array<Counts, kMostPlaces> gains{};
  const auto per_step = static_cast<float>(1.0 / params.shift_step_cells);
  const auto turn = static_cast<float>(turn_cells);
  const auto first = static_cast<float>(-half * params.shift_step_cells);
  for (const Crossing& crossing : crossings.all) {
    const float steps = (crossing.at_cells - turn * crossing.per_turn - first) * per_step;
    const int next = std::clamp(static_cast<int>(steps + 1.0F), 0, places);  // the first place beyond
    gains[static_cast<std::size_t>(next)] += crossing.gain;
  }
  BestShift best;
  Counts sum = crossings.before;
  Counts best_sum = 0;
  int from = 0;
  int to = 0;
  for (int i = 0; i < places; ++i) {
    sum += gains[static_cast<std::size_t>(i)];
    if (sum == best_sum && to + 1 == i) {
      to = i;
      continue;
    }
    const double gain = agreeing_in(sum) - acceptance * known_in(sum);
    if (gain > best.gain) best.gain = gain, best_sum = sum, from = to = i;
  }
  best.shift_cells = (0.5 * (from + to) - half) * params.shift_step_cells;
  return best;
}

struct Pose {
  Eigen::Vector3d step_cells;
  double gain = 0.0;
};

}  // namespace

mapping::merge::CellMotion best_nearby(const OccupancyGrid& map, std::span<const EdgeCell> edges,
                                       const mapping::merge::CellMotion& start, const BestNearbyParams& params) {
  const double lever_cells = lever_of(edges);
  const CellsNearBorders near = cells_near_borders(map, edges, start, lever_cells, params.reach_cells);
  if (near.at_start == 0) return start;
  const double acceptance = agreeing_in(near.at_start) / known_in(near.at_start);
  std::vector<Pose> poses;
  const auto look = [&](double turn_cells) {
    const BestShift x = best_shift(near.x, turn_cells, acceptance, params);
    const BestShift y = best_shift(near.y, turn_cells, acceptance, params);
    poses.push_back({{x.shift_cells, y.shift_cells, turn_cells}, x.gain + y.gain});
  };
  const auto sort_best_first = [&] {
    std::stable_sort(poses.begin(), poses.end(), [](const Pose& a, const Pose& b) { return a.gain > b.gain; });
  };
  const int half = static_cast<int>(std::lround(params.reach_cells / params.turn_step_cells));
  look(0.0);  // first: of equals, the pose that was there
  for (int i = 1; i <= half; ++i) {
    for (const int turns : {-i, i}) look(turns * params.turn_step_cells);
  }
  double step_cells = params.turn_step_cells;
  for (int i = 0; i < kHalvings; ++i) {
    step_cells *= 0.5;
    sort_best_first();
    for (std::size_t k = 0; k < std::min(kParted, poses.size()); ++k) {
      const double turn_cells = poses[k].step_cells.z();
      for (const double beside : {turn_cells - step_cells, turn_cells + step_cells}) look(beside);
    }
  }
  sort_best_first();
  return moved(start, poses.front().step_cells, lever_cells);
}

}  // namespace deltamap::surveying::grid_registration
