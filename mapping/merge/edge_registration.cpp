// SPDX-License-Identifier: Apache-2.0
#include "mapping/merge/edge_registration.hpp"

#include <Eigen/Core>
#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <cstdint>

namespace deltamap::mapping::merge {
namespace {

constexpr int kReach_cells = 2;
constexpr int kLeastPaired = 20;

struct NormalEquations {
  Eigen::Matrix3d matrix = Eigen::Matrix3d::Zero();
  Eigen::Vector3d right_side = Eigen::Vector3d::Zero();
  int paired = 0;
};

/// The turn counts as what it moves a point at the lever arm, so that all three unknowns are cells.
NormalEquations normal_equations(const OccupancyGrid& map, const std::vector<EdgeCell>& edges, const CellMotion& motion,
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
  NormalEquations sums;
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
    const float rest = edge.value - (left + u * gx);
    xx += gx * gx, xy += gx * gy, xt += gx * gt, yy += gy * gy, yt += gy * gt, tt += gt * gt;
    bx += gx * rest, by += gy * rest, bt += gt * rest;
  }
  sums.matrix << xx, xy, xt, xy, yy, yt, xt, yt, tt;
  sums.right_side << bx, by, bt;
  return sums;
}

/// The step along the axes that the edges observe.
Eigen::Vector3d observed_step(const NormalEquations& sums, double least_observed) {
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> axes{sums.matrix};
  Eigen::Vector3d step = Eigen::Vector3d::Zero();
  for (int i = 0; i < 3; ++i) {
    const double curvature = axes.eigenvalues()[i];
    if (curvature <= least_observed * axes.eigenvalues()[2]) continue;
    const Eigen::Vector3d axis = axes.eigenvectors().col(i);
    step += axis.dot(sums.right_side) / curvature * axis;
  }
  return step;
}

/// How far a turn of 1 rad moves the edges, root mean square.
double lever_of(const std::vector<EdgeCell>& edges) {
  double squares = 0.0;
  for (const EdgeCell& edge : edges) squares += edge.at.x * edge.at.x + edge.at.y * edge.at.y;
  return std::max(1.0, std::sqrt(squares / std::max(1.0, static_cast<double>(edges.size()))));
}

}  // namespace

std::vector<EdgeCell> edge_cells(const OccupancyGrid& local, const LocalCells& cells, std::size_t most_cells) {
  const Point2 middle = (cells.middle_in_local() - local.geometry().origin) / local.resolution_m();
  std::vector<std::uint8_t> taken(local.geometry().cell_count(), 0);
  std::vector<EdgeCell> edges;
  for (const PointInCells& at : cells.contour()) {
    const int column = static_cast<int>(std::lround(at.x + middle.x() - 0.5));
    const int row = static_cast<int>(std::lround(at.y + middle.y() - 0.5));
    for (int y = std::max(0, row - kReach_cells); y <= std::min(local.height() - 1, row + kReach_cells); ++y) {
      for (int x = std::max(0, column - kReach_cells); x <= std::min(local.width() - 1, column + kReach_cells); ++x) {
        const std::size_t index = local.geometry().index_of({x, y});
        if (taken[index] != 0 || local.cells()[index] == CellState::kUnknown) continue;
        taken[index] = 1;
        edges.push_back({{static_cast<float>(x + 0.5 - middle.x()), static_cast<float>(y + 0.5 - middle.y())},
                         local.cells()[index] == CellState::kOccupied ? 1.0F : -1.0F});
      }
    }
  }
  const std::size_t stride = edges.size() / std::max<std::size_t>(1, most_cells) + 1;
  if (stride == 1) return edges;
  std::vector<EdgeCell> thinned;
  for (std::size_t i = 0; i < edges.size(); i += stride) thinned.push_back(edges[i]);
  return thinned;
}

CellMotion edge_registration(const OccupancyGrid& map, const std::vector<EdgeCell>& edges, const CellMotion& start,
                             const EdgeRegistrationParams& params) {
  const double lever_cells = lever_of(edges);
  CellMotion motion = start;
  for (int i = 0; i < params.most_iterations; ++i) {
    const NormalEquations sums = normal_equations(map, edges, motion, lever_cells);
    if (sums.paired < kLeastPaired) return start;
    const Eigen::Vector3d step = observed_step(sums, params.least_observed);
    motion = {motion.turn_rad + step.z() / lever_cells, motion.column + step.x(), motion.row + step.y()};
    const double turned_cells = lever_cells * std::abs(motion.turn_rad - start.turn_rad);
    const double moved_cells = std::hypot(motion.column - start.column, motion.row - start.row);
    if (std::max(turned_cells, moved_cells) > params.most_correction_cells) return start;
    if (step.cwiseAbs().maxCoeff() < params.settled_cells) break;
  }
  return motion;
}

CellMotion best_nearby(const OverlayMap& map, const std::vector<EdgeCell>& edges, const CellMotion& start,
                       double step_cells, int rounds) {
  std::vector<PointInCells> occupied;
  std::vector<PointInCells> free;
  for (const EdgeCell& edge : edges) (edge.value > 0.0F ? occupied : free).push_back(edge.at);
  const double lever_cells = lever_of(edges);
  CellMotion best = start;
  Acceptance best_counts = map.counted(occupied, free, best);
  for (int round = 0; round < rounds; ++round) {
    const CellMotion centre = best;
    for (const double step : {step_cells, -step_cells}) {
      for (const CellMotion& motion : {CellMotion{centre.turn_rad, centre.column + step, centre.row},
                                       CellMotion{centre.turn_rad, centre.column, centre.row + step},
                                       CellMotion{centre.turn_rad + step / lever_cells, centre.column, centre.row}}) {
        const Acceptance counts = map.counted(occupied, free, motion);
        if (counts.value() <= best_counts.value()) continue;
        best_counts = counts;
        best = motion;
      }
    }
    if (best == centre) step_cells *= 0.5;
  }
  return best;
}

}  // namespace deltamap::mapping::merge
