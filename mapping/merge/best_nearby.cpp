// SPDX-License-Identifier: Apache-2.0
#include "mapping/merge/best_nearby.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "mapping/merge/acceptance.hpp"
#include "mapping/merge/motion_equations.hpp"

namespace deltamap::mapping::merge {
namespace {

// By the local map's state and the map's: agreeing cells in the lower half, disagreeing ones in the upper.
constexpr std::uint64_t kAgrees = 1;
constexpr std::uint64_t kDisagrees = 1ULL << 32U;
constexpr std::array<std::uint64_t, 6> kPackedCounts{kAgrees, kDisagrees, 0, kDisagrees, kAgrees, 0};

/// Eq. 11 of the cells along the edges near a pose. A cell that meets the same state wherever the pose may move is
/// counted once; only the others are looked at again. Those at the rim of the map do not count.
class NearbyAcceptance {
 public:
  /// The cells move by less than `margin_cells` (< 0.5).
  NearbyAcceptance(const OccupancyGrid& map, std::span<const EdgeCell> edges, const CellMotion& motion,
                   float margin_cells)
      : cells_{map.cells().data()}, width_{map.width()} {
    const Placing place{motion};
    for (const EdgeCell& edge : edges) {
      const PointInCells at = place(edge.at);
      if (!(at.x >= 1.0F && at.y >= 1.0F && at.x < static_cast<float>(map.width() - 1) &&
            at.y < static_cast<float>(map.height() - 1))) {
        continue;
      }
      if (is_settled(at, margin_cells)) {
        settled_ += packed(edge.state, *cell_at(at));
      } else {
        left_.push_back(edge);
      }
    }
  }

  [[nodiscard]] double at(const CellMotion& motion) const {
    const Placing place{motion};
    std::uint64_t sum = settled_;
    for (const EdgeCell& edge : left_) sum += packed(edge.state, *cell_at(place(edge.at)));
    return Acceptance{sum & 0xFFFFFFFFU, sum >> 32U}.value();
  }

 private:
  struct Placing {
    float c, s, tx, ty;
    explicit Placing(const CellMotion& motion)
        : c{static_cast<float>(std::cos(motion.turn_rad))},
          s{static_cast<float>(std::sin(motion.turn_rad))},
          tx{static_cast<float>(motion.column)},
          ty{static_cast<float>(motion.row)} {}
    PointInCells operator()(const PointInCells& at) const {
      return {c * at.x - s * at.y + tx, s * at.x + c * at.y + ty};
    }
  };
  static std::uint64_t packed(CellState local, CellState map) {
    return kPackedCounts[3 * static_cast<std::size_t>(local) + static_cast<std::size_t>(map)];
  }
  [[nodiscard]] const CellState* cell_at(const PointInCells& at) const {
    return cells_ + static_cast<std::int32_t>(at.y) * width_ + static_cast<std::int32_t>(at.x);
  }
  /// Whether all cells that may be reached have one state.
  [[nodiscard]] bool is_settled(const PointInCells& at, float margin_cells) const {
    const float u = at.x - static_cast<float>(static_cast<std::int32_t>(at.x));
    const float v = at.y - static_cast<float>(static_cast<std::int32_t>(at.y));
    const std::ptrdiff_t beside = u < margin_cells ? -1 : u > 1.0F - margin_cells ? 1 : 0;
    const std::ptrdiff_t above = v < margin_cells ? -width_ : v > 1.0F - margin_cells ? width_ : 0;
    const CellState* const here = cell_at(at);
    return here[beside] == *here && here[above] == *here && here[above + beside] == *here;
  }

  const CellState* cells_;
  std::ptrdiff_t width_;
  std::vector<EdgeCell> left_;
  std::uint64_t settled_ = 0;
};

}  // namespace

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
    const CellMotion before = best;
    for (const int axis : {0, 1, 2}) {
      for (const double step : {step_cells, -step_cells}) {
        const CellMotion motion = moved(best, step * Eigen::Vector3d::Unit(axis), lever_cells);
        if (!is_near(motion)) continue;
        const double acceptance = acceptance_at.at(motion);
        if (acceptance <= best_acceptance) continue;
        best_acceptance = acceptance;
        best = motion;
        break;
      }
    }
    if (best == before) step_cells *= 0.5;
  }
  return best;
}

}  // namespace deltamap::mapping::merge
