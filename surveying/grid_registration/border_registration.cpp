// SPDX-License-Identifier: Apache-2.0
#include "surveying/grid_registration/border_registration.hpp"

#include <algorithm>
#include <cmath>

#include "mapping/registration/acceptance.hpp"
#include "surveying/grid_registration/motion_equations.hpp"

namespace deltamap::surveying::grid_registration {
namespace {

/// The nearest side of a cell beyond which the map has the other state.
struct Border {
  float distance_cells = 1.0F;  // 1: none on the half of the cell that was asked for
  float side = 0.0F;            // -1 or 1
  bool along_x = false;
};

/// Of a known cell with four neighbours; asked for at (u, v) in it.
Border nearest_border(const OccupancyGrid& map, Cell cell, float u, float v) {
  const CellState here = map[cell];
  const CellState beside = map[{cell.column + (u < 0.5F ? -1 : 1), cell.row}];
  const CellState above = map[{cell.column, cell.row + (v < 0.5F ? -1 : 1)}];
  const bool is_border_x = beside != here && beside != CellState::kUnknown;
  const bool is_border_y = above != here && above != CellState::kUnknown;
  if (!is_border_x && !is_border_y) return {};
  const float to_x = std::min(u, 1.0F - u);
  const float to_y = std::min(v, 1.0F - v);
  if (is_border_x && (!is_border_y || to_x < to_y)) return {to_x, u < 0.5F ? -1.0F : 1.0F, true};
  return {to_y, v < 0.5F ? -1.0F : 1.0F, false};
}

struct BorderSums {
  MotionEquations equations;
  mapping::registration::Acceptance acceptance;
};

BorderSums border_sums(const OccupancyGrid& map, std::span<const EdgeCell> edges,
                       const mapping::merge::CellMotion& motion, double lever_cells, float margin_cells) {
  const auto c = static_cast<float>(std::cos(motion.turn_rad));
  const auto s = static_cast<float>(std::sin(motion.turn_rad));
  const auto tx = static_cast<float>(motion.column);
  const auto ty = static_cast<float>(motion.row);
  const auto per_lever = static_cast<float>(1.0 / lever_cells);
  float xx = 0.0F, xt = 0.0F, yy = 0.0F, yt = 0.0F, tt = 0.0F, bx = 0.0F, by = 0.0F, bt = 0.0F;
  BorderSums sums;
  for (const EdgeCell& edge : edges) {
    const float arm_x = c * edge.at.x - s * edge.at.y;
    const float arm_y = s * edge.at.x + c * edge.at.y;
    const float x = arm_x + tx;
    const float y = arm_y + ty;
    if (!(x >= 1.0F && y >= 1.0F)) continue;
    const int column = static_cast<int>(x);
    const int row = static_cast<int>(y);
    if (column + 1 >= map.width() || row + 1 >= map.height()) continue;
    const CellState here = map[{column, row}];
    if (here == CellState::kUnknown) continue;
    const bool agrees = here == edge.state;
    ++(agrees ? sums.acceptance.agreeing : sums.acceptance.disagreeing);
    const Border border =
        nearest_border(map, {column, row}, x - static_cast<float>(column), y - static_cast<float>(row));
    if (border.distance_cells >= (agrees ? margin_cells : 1.0F)) continue;
    // Towards the border, and beyond it by the margin; or away from it, until the margin is reached.
    const float rest = border.distance_cells + (agrees ? -margin_cells : margin_cells);
    const float gt = border.side * (border.along_x ? -arm_y : arm_x) * per_lever;
    ++sums.equations.paired;
    (border.along_x ? xx : yy) += 1.0F;
    (border.along_x ? xt : yt) += border.side * gt;
    (border.along_x ? bx : by) += border.side * rest;
    tt += gt * gt, bt += gt * rest;
  }
  sums.equations.matrix << xx, 0.0F, xt, 0.0F, yy, yt, xt, yt, tt;
  sums.equations.right_side << bx, by, bt;
  return sums;
}

}  // namespace

mapping::merge::CellMotion border_registration(const OccupancyGrid& map, std::span<const EdgeCell> edges,
                                               const mapping::merge::CellMotion& start,
                                               const BorderRegistrationParams& params) {
  const double lever_cells = lever_of(edges);
  mapping::merge::CellMotion motion = start;
  mapping::merge::CellMotion best = start;
  double best_acceptance = -1.0;
  for (int i = 0; i <= params.most_iterations; ++i) {
    const BorderSums sums = border_sums(map, edges, motion, lever_cells, static_cast<float>(params.margin_cells));
    const double acceptance = sums.acceptance.value();
    if (acceptance > best_acceptance) best_acceptance = acceptance, best = motion;
    if (sums.acceptance.disagreeing == 0 || sums.equations.paired < kLeastPaired) break;
    const Eigen::Vector3d step = observed_step(sums.equations);
    if (step.cwiseAbs().maxCoeff() < params.settled_cells) break;
    motion = moved(motion, step, lever_cells);
  }
  return best;
}

}  // namespace deltamap::surveying::grid_registration
