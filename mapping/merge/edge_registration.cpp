// SPDX-License-Identifier: Apache-2.0
#include "mapping/merge/edge_registration.hpp"

#include <Eigen/Core>
#include <Eigen/Eigenvalues>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>

namespace deltamap::mapping::merge {
namespace {

constexpr int kReach_cells = 1;
constexpr int kLeastPaired = 20;

// By the local map's state and the map's: agreeing cells in the lower half, disagreeing ones in the upper.
constexpr std::uint64_t kAgrees = 1;
constexpr std::uint64_t kDisagrees = 1ULL << 32U;
constexpr std::array<std::uint64_t, 6> kPackedCounts{kAgrees, kDisagrees, 0, kDisagrees, kAgrees, 0};

struct NormalEquations {
  Eigen::Matrix3d matrix = Eigen::Matrix3d::Zero();
  Eigen::Vector3d right_side = Eigen::Vector3d::Zero();
  int paired = 0;
};

/// The turn counts as what it moves a point at the lever arm, so that all three unknowns are cells.
NormalEquations normal_equations(const OccupancyGrid& map, std::span<const EdgeCell> edges, const CellMotion& motion,
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
    const float rest = kValue[static_cast<int>(edge.state)] - (left + u * gx);
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
double lever_of(std::span<const EdgeCell> edges) {
  double squares = 0.0;
  for (const EdgeCell& edge : edges) squares += edge.at.x * edge.at.x + edge.at.y * edge.at.y;
  return std::max(1.0, std::sqrt(squares / std::max(1.0, static_cast<double>(edges.size()))));
}

/// Eq. 11 of the cells along the edges near a pose. A cell that meets the same state wherever the pose may move is
/// counted once; only the others are looked at again.
class NearbyAcceptance {
 public:
  /// The cells move by less than `margin_cells` (< 0.5).
  NearbyAcceptance(const OccupancyGrid& map, std::span<const EdgeCell> edges, const CellMotion& motion,
                   float margin_cells)
      : map_{map} {
    const Placing place{motion};
    for (const EdgeCell& edge : edges) {
      const PointInCells at = place(edge.at);
      const CellState state = state_at(at.x - margin_cells, at.y - margin_cells);
      const bool is_settled = state == state_at(at.x + margin_cells, at.y - margin_cells) &&
                              state == state_at(at.x - margin_cells, at.y + margin_cells) &&
                              state == state_at(at.x + margin_cells, at.y + margin_cells);
      if (is_settled) {
        settled_ += packed(edge.state, state);
      } else {
        left_.push_back(edge);
      }
    }
  }

  [[nodiscard]] double at(const CellMotion& motion) const {
    const Placing place{motion};
    std::uint64_t sum = settled_;
    for (const EdgeCell& edge : left_) {
      const PointInCells at = place(edge.at);
      sum += packed(edge.state, state_at(at.x, at.y));
    }
    return Acceptance{sum & 0xFFFFFFFFU, sum >> 32U}.value();
  }

 private:
  struct Placing {
    float c, s, tx, ty;
    explicit Placing(const CellMotion& motion)
        : c{static_cast<float>(std::cos(motion.turn_rad))},
          s{static_cast<float>(std::sin(motion.turn_rad))},
          tx{static_cast<float>(motion.column + 1.0)},  // truncation is floor from one cell left of the map on
          ty{static_cast<float>(motion.row + 1.0)} {}
    PointInCells operator()(const PointInCells& at) const {
      return {c * at.x - s * at.y + tx, s * at.x + c * at.y + ty};
    }
  };
  static std::uint64_t packed(CellState local, CellState map) {
    return kPackedCounts[3 * static_cast<std::size_t>(local) + static_cast<std::size_t>(map)];
  }
  [[nodiscard]] CellState state_at(float x_after_border, float y_after_border) const {
    const auto x = static_cast<std::uint32_t>(static_cast<std::int32_t>(x_after_border)) - 1U;
    const auto y = static_cast<std::uint32_t>(static_cast<std::int32_t>(y_after_border)) - 1U;
    const auto width = static_cast<std::uint32_t>(map_.width());
    if (x >= width || y >= static_cast<std::uint32_t>(map_.height())) return CellState::kUnknown;
    return map_.cells()[std::size_t{y} * width + x];
  }

  const OccupancyGrid& map_;
  std::vector<EdgeCell> left_;
  std::uint64_t settled_ = 0;
};

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

CellMotion best_nearby(const OccupancyGrid& map, std::span<const EdgeCell> edges, const CellMotion& start,
                       double step_cells, int rounds) {
  const double lever_cells = lever_of(edges);
  CellMotion best = start;
  const double most_moved_cells = 2.0 * step_cells;
  // A turn moves the farthest cells by about twice what it moves those at the lever arm; not all axes move at once.
  const NearbyAcceptance acceptance_at{map, edges, start, static_cast<float>(std::min(0.49, 4.0 * step_cells))};
  const auto is_near = [&](const CellMotion& motion) {
    return std::abs(motion.column - start.column) <= most_moved_cells &&
           std::abs(motion.row - start.row) <= most_moved_cells &&
           lever_cells * std::abs(motion.turn_rad - start.turn_rad) <= most_moved_cells;
  };
  double best_acceptance = acceptance_at.at(best);
  for (int round = 0; round < rounds; ++round) {
    const CellMotion centre = best;
    for (const double step : {step_cells, -step_cells}) {
      for (const CellMotion& motion : {CellMotion{centre.turn_rad, centre.column + step, centre.row},
                                       CellMotion{centre.turn_rad, centre.column, centre.row + step},
                                       CellMotion{centre.turn_rad + step / lever_cells, centre.column, centre.row}}) {
        if (!is_near(motion)) continue;
        const double acceptance = acceptance_at.at(motion);
        if (acceptance <= best_acceptance) continue;
        best_acceptance = acceptance;
        best = motion;
      }
    }
    if (best == centre) step_cells *= 0.5;
  }
  return best;
}

}  // namespace deltamap::mapping::merge
