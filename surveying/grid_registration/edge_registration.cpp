// SPDX-License-Identifier: Apache-2.0
#include "surveying/grid_registration/edge_registration.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <optional>

#include "surveying/grid_registration/motion_equations.hpp"

namespace deltamap::surveying::grid_registration {
namespace {

constexpr std::size_t kBits = 64;        // of a word
constexpr std::uint64_t kThree = 0b111;  // cells in a row: an edge and those beside it

constexpr float kValue[3] = {-1.0F, 1.0F, 0.0F};  // by CellState

/// The values of the four cells about a point, and where between them it lies.
struct Patch {
  float low_left, low_right, high_left, high_right;
  float u, v;
  [[nodiscard]] bool is_level() const {
    return low_left == low_right && low_left == high_left && low_left == high_right;
  }
};

/// Nothing beside the map, or where one of the cells is unknown. Cell centres lie on whole numbers.
std::optional<Patch> patch_at(const OccupancyGrid& map, float x, float y) {
  if (!(x >= 0.0F && y >= 0.0F)) return std::nullopt;
  const int column = static_cast<int>(x);
  const int row = static_cast<int>(y);
  if (column + 1 >= map.width() || row + 1 >= map.height()) return std::nullopt;
  const CellState low[2] = {map[{column, row}], map[{column + 1, row}]};
  const CellState high[2] = {map[{column, row + 1}], map[{column + 1, row + 1}]};
  if (low[0] == CellState::kUnknown || low[1] == CellState::kUnknown || high[0] == CellState::kUnknown ||
      high[1] == CellState::kUnknown) {
    return std::nullopt;
  }
  return Patch{kValue[static_cast<int>(low[0])],  kValue[static_cast<int>(low[1])], kValue[static_cast<int>(high[0])],
               kValue[static_cast<int>(high[1])], x - static_cast<float>(column),   y - static_cast<float>(row)};
}

/// The normal equations of x, y and turn.
struct NormalSums {
  float xx = 0.0F, xy = 0.0F, xt = 0.0F, yy = 0.0F, yt = 0.0F, tt = 0.0F, bx = 0.0F, by = 0.0F, bt = 0.0F;
  void add(float gx, float gy, float gt, float rest) {
    xx += gx * gx, xy += gx * gy, xt += gx * gt, yy += gy * gy, yt += gy * gt, tt += gt * gt;
    bx += gx * rest, by += gy * rest, bt += gt * rest;
  }
};

MotionEquations motion_equations(const OccupancyGrid& map, std::span<const EdgeCell> edges,
                                 const mapping::merge::CellMotion& motion, double lever_cells) {
  const auto c = static_cast<float>(std::cos(motion.turn_rad));
  const auto s = static_cast<float>(std::sin(motion.turn_rad));
  const auto tx = static_cast<float>(motion.column - 0.5);  // cell centres on whole numbers
  const auto ty = static_cast<float>(motion.row - 0.5);
  const auto per_lever = static_cast<float>(1.0 / lever_cells);
  NormalSums sums;
  MotionEquations equations;
  for (const EdgeCell& edge : edges) {
    const float arm_x = c * edge.at.x - s * edge.at.y;
    const float arm_y = s * edge.at.x + c * edge.at.y;
    const auto patch = patch_at(map, arm_x + tx, arm_y + ty);
    if (!patch) continue;
    ++equations.paired;
    if (patch->is_level()) continue;  // tells nothing
    const auto& [low_left, low_right, high_left, high_right, u, v] = *patch;
    const float left = low_left + v * (high_left - low_left);
    const float right = low_right + v * (high_right - low_right);
    const float gx = right - left;
    const float gy = high_left - low_left + u * (high_right - low_right - high_left + low_left);
    const float gt = (gy * arm_x - gx * arm_y) * per_lever;
    sums.add(gx, gy, gt, kValue[static_cast<int>(edge.state)] - (left + u * gx));
  }
  equations.matrix << sums.xx, sums.xy, sums.xt, sums.xy, sums.yy, sums.yt, sums.xt, sums.yt, sums.tt;
  equations.right_side << sums.bx, sums.by, sums.bt;
  return equations;
}

}  // namespace

std::vector<EdgeCell> edge_cells(const OccupancyGrid& local, std::span<const Cell> contour, const Point2& middle) {
  // A bit a cell, with a rim of one; bit 0 of a row is the rim's.
  const auto width = static_cast<std::size_t>(local.width());
  const std::size_t words = (width + 2) / kBits + 1;
  std::vector<std::uint64_t> marks(words * static_cast<std::size_t>(local.height() + 2), 0);
  for (const Cell& cell : contour) {
    const auto first = static_cast<std::size_t>(cell.column);  // bit of the cell to the left
    std::uint64_t* const word = marks.data() + static_cast<std::size_t>(cell.row) * words + first / kBits;
    const std::size_t shift = first % kBits;
    for (const std::size_t row : {std::size_t{0}, words, 2 * words}) {
      word[row] |= kThree << shift;
      if (shift + 3 > kBits) word[row + 1] |= kThree >> (kBits - shift);
    }
  }
  std::vector<EdgeCell> edges;
  edges.reserve(6 * contour.size());
  const auto to_x = static_cast<float>(0.5 - middle.x());
  const auto to_y = static_cast<float>(0.5 - middle.y());
  for (std::size_t row = 0; row < static_cast<std::size_t>(local.height()); ++row) {
    const std::uint64_t* const word = marks.data() + (row + 1) * words;
    for (std::size_t i = 0; i < words; ++i) {
      for (std::uint64_t left = word[i]; left != 0; left &= left - 1) {
        const std::size_t column = i * kBits + static_cast<std::size_t>(std::countr_zero(left)) - 1;
        if (column >= width) continue;
        const CellState state = local[{static_cast<int>(column), static_cast<int>(row)}];
        if (state == CellState::kUnknown) continue;
        edges.push_back({{static_cast<float>(column) + to_x, static_cast<float>(row) + to_y}, state});
      }
    }
  }
  return edges;
}

std::vector<EdgeCell> edge_cells(const OccupancyGrid& local) {
  const std::vector<Cell> contour = contour_cells(local);
  return edge_cells(local, contour, mapping::merge::middle_of(contour, local));
}

mapping::registration::Acceptance edge_acceptance(const OccupancyGrid& map, std::span<const EdgeCell> edges,
                                                  const mapping::merge::CellMotion& motion) {
  const double c = std::cos(motion.turn_rad);
  const double s = std::sin(motion.turn_rad);
  mapping::registration::Acceptance counts;
  for (const EdgeCell& edge : edges) {
    const double x = c * edge.at.x - s * edge.at.y + motion.column;
    const double y = s * edge.at.x + c * edge.at.y + motion.row;
    if (!(x >= 0.0 && y >= 0.0 && x < map.width() && y < map.height())) continue;
    counts.add(edge.state, map[{static_cast<int>(x), static_cast<int>(y)}]);
  }
  return counts;
}

mapping::merge::CellMotion edge_registration(const OccupancyGrid& map, std::span<const EdgeCell> edges,
                                             const mapping::merge::CellMotion& start,
                                             const EdgeRegistrationParams& params) {
  const double lever_cells = lever_of(edges);
  mapping::merge::CellMotion motion = start;
  for (int i = 0; i < params.most_iterations; ++i) {
    const MotionEquations sums = motion_equations(map, edges, motion, lever_cells);
    if (sums.paired < kLeastPaired) return start;
    const Eigen::Vector3d step = observed_step(sums);
    motion = moved(motion, step, lever_cells);
    const double turned_cells = lever_cells * std::abs(motion.turn_rad - start.turn_rad);
    const double moved_cells = std::hypot(motion.column - start.column, motion.row - start.row);
    if (std::max(turned_cells, moved_cells) > params.most_correction_cells) return start;
    if (step.cwiseAbs().maxCoeff() < params.settled_cells) break;
  }
  return motion;
}

}  // namespace deltamap::surveying::grid_registration
