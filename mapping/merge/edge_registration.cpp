// SPDX-License-Identifier: Apache-2.0
#include "mapping/merge/edge_registration.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "mapping/merge/motion_equations.hpp"

namespace deltamap::mapping::merge {
namespace {

constexpr int kReach_cells = 1;
constexpr int kLeastPaired = 20;

MotionEquations motion_equations(const OccupancyGrid& map, std::span<const EdgeCell> edges, const CellMotion& motion,
                                 double lever_cells) {
  constexpr float kValue[3] = {-1.0F, 1.0F, 0.0F};  // by CellState
  const auto c = static_cast<float>(std::cos(motion.turn_rad));
  const auto s = static_cast<float>(std::sin(motion.turn_rad));
  const auto tx = static_cast<float>(motion.column - 0.5);  // cell centres on whole numbers
  const auto ty = static_cast<float>(motion.row - 0.5);
  const auto per_lever = static_cast<float>(1.0 / lever_cells);
  const auto width = static_cast<std::size_t>(map.width());
  const CellState* const cells = map.cells().data();
  float xx = 0.0F, xy = 0.0F, xt = 0.0F, yy = 0.0F, yt = 0.0F, tt = 0.0F, bx = 0.0F, by = 0.0F, bt = 0.0F;
  MotionEquations sums;
  for (const EdgeCell& edge : edges) {
    const float arm_x = c * edge.at.x - s * edge.at.y;
    const float arm_y = s * edge.at.x + c * edge.at.y;
    const float x = arm_x + tx;
    const float y = arm_y + ty;
    if (!(x >= 0.0F && y >= 0.0F)) continue;
    const int column = static_cast<int>(x);
    const int row = static_cast<int>(y);
    if (column + 1 >= map.width() || row + 1 >= map.height()) continue;
    const CellState* const low = cells + static_cast<std::size_t>(row) * width + static_cast<std::size_t>(column);
    const CellState* const high = low + width;
    if (low[0] == CellState::kUnknown || low[1] == CellState::kUnknown || high[0] == CellState::kUnknown ||
        high[1] == CellState::kUnknown) {
      continue;
    }
    ++sums.paired;
    const float low_left = kValue[static_cast<int>(low[0])];
    const float low_right = kValue[static_cast<int>(low[1])];
    const float high_left = kValue[static_cast<int>(high[0])];
    const float high_right = kValue[static_cast<int>(high[1])];
    if (low_left == low_right && low_left == high_left && low_left == high_right) continue;  // level: tells nothing
    const float u = x - static_cast<float>(column);
    const float v = y - static_cast<float>(row);
    const float left = low_left + v * (high_left - low_left);
    const float right = low_right + v * (high_right - low_right);
    const float gx = right - left;
    const float gy = high_left - low_left + u * (high_right - low_right - high_left + low_left);
    const float gt = (gy * arm_x - gx * arm_y) * per_lever;
    const float rest = kValue[static_cast<int>(edge.state)] - (left + u * gx);
    xx += gx * gx, xy += gx * gy, xt += gx * gt, yy += gy * gy, yt += gy * gt, tt += gt * gt;
    bx += gx * rest, by += gy * rest, bt += gt * rest;
  }
  sums.matrix << xx, xy, xt, xy, yy, yt, xt, yt, tt;
  sums.right_side << bx, by, bt;
  return sums;
}

}  // namespace

std::vector<EdgeCell> edge_cells(const OccupancyGrid& local, std::span<const Cell> contour, const Point2& middle) {
  std::vector<std::uint8_t> taken(local.geometry().cell_count(), 0);
  std::vector<EdgeCell> edges;
  edges.reserve(6 * contour.size());
  const auto width = static_cast<std::size_t>(local.width());
  const auto to_x = static_cast<float>(0.5 - middle.x());
  const auto to_y = static_cast<float>(0.5 - middle.y());
  for (const Cell& cell : contour) {
    const int first = std::max(0, cell.column - kReach_cells);
    const int last = std::min(local.width() - 1, cell.column + kReach_cells);
    for (int y = std::max(0, cell.row - kReach_cells); y <= std::min(local.height() - 1, cell.row + kReach_cells);
         ++y) {
      const std::size_t row = static_cast<std::size_t>(y) * width;
      for (int x = first; x <= last; ++x) {
        std::uint8_t& is_taken = taken[row + static_cast<std::size_t>(x)];
        const CellState state = local.cells()[row + static_cast<std::size_t>(x)];
        if (is_taken != 0 || state == CellState::kUnknown) continue;
        is_taken = 1;
        edges.push_back({{static_cast<float>(x) + to_x, static_cast<float>(y) + to_y}, state});
      }
    }
  }
  return edges;
}

std::vector<EdgeCell> edge_cells(const OccupancyGrid& local) {
  const std::vector<Cell> contour = contour_cells(local);
  return edge_cells(local, contour, middle_of(contour, local));
}

CellMotion edge_registration(const OccupancyGrid& map, std::span<const EdgeCell> edges, const CellMotion& start,
                             const EdgeRegistrationParams& params) {
  const double lever_cells = lever_of(edges);
  CellMotion motion = start;
  for (int i = 0; i < params.most_iterations; ++i) {
    const MotionEquations sums = motion_equations(map, edges, motion, lever_cells);
    if (sums.paired < kLeastPaired) return start;
    const Eigen::Vector3d step = observed_step(sums, params.least_observed);
    motion = moved(motion, step, lever_cells);
    const double turned_cells = lever_cells * std::abs(motion.turn_rad - start.turn_rad);
    const double moved_cells = std::hypot(motion.column - start.column, motion.row - start.row);
    if (std::max(turned_cells, moved_cells) > params.most_correction_cells) return start;
    if (step.cwiseAbs().maxCoeff() < params.settled_cells) break;
  }
  return motion;
}

}  // namespace deltamap::mapping::merge
