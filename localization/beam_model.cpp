// SPDX-License-Identifier: Apache-2.0
#include "localization/beam_model.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "localization/likelihood_field.hpp"

namespace deltamap::localization {
namespace {

constexpr double kShortestStepCells = 0.25;
constexpr double kToSurfaceCells = 0.375;  // from where a step lands in a cell to its middle, on average
constexpr int kFarthestClear = 255;

double normal_density(double off, double deviation) {
  return std::exp(-0.5 * off * off / (deviation * deviation)) / (deviation * std::sqrt(2.0 * std::numbers::pi));
}

/// Share of a normal distribution around `mean` that lies in [0, most].
double share_inside(double mean, double deviation, double most) {
  const double scale = 1.0 / (deviation * std::numbers::sqrt2);
  return 0.5 * (std::erf((most - mean) * scale) + std::erf(mean * scale));
}

/// Chessboard distance to the nearest cell that is not free, in two passes over the grid.
std::vector<std::uint8_t> clear_cells(const OccupancyGrid& map) {
  const int width = map.width();
  const int height = map.height();
  std::vector<std::uint8_t> clear(map.geometry().cell_count());
  const auto at = [&](int column, int row) -> int {
    if (column < 0 || row < 0 || column >= width || row >= height) return 0;
    return clear[static_cast<std::size_t>(row) * static_cast<std::size_t>(width) + static_cast<std::size_t>(column)];
  };
  const auto lower = [&](int column, int row, int least) {
    auto& cell = clear[map.geometry().index_of({column, row})];
    cell = static_cast<std::uint8_t>(std::min({static_cast<int>(cell), least + 1, kFarthestClear}));
  };
  for_each_known(map, [&](Cell cell, CellState state) {
    if (state == CellState::kFree) clear[map.geometry().index_of(cell)] = kFarthestClear;
  });
  for (int row = 0; row < height; ++row) {
    for (int column = 0; column < width; ++column) {
      lower(column, row,
            std::min({at(column - 1, row), at(column - 1, row - 1), at(column, row - 1), at(column + 1, row - 1)}));
    }
  }
  for (int row = height; row-- > 0;) {
    for (int column = width; column-- > 0;) {
      lower(column, row,
            std::min({at(column + 1, row), at(column + 1, row + 1), at(column, row + 1), at(column - 1, row + 1)}));
    }
  }
  return clear;
}

}  // namespace

BeamLikelihood::BeamLikelihood(const BeamModelParams& params, double max_range_m)
    : params_{params},
      max_range_m_{max_range_m},
      greatest_{hit_share() * normal_density(0.0, params.hit_deviation_m) / 0.5 +
                params.short_share * params.short_per_m + params.random_share / max_range_m} {}

double BeamLikelihood::hit_share() const {
  return 1.0 - params_.short_share - params_.max_share - params_.random_share;
}

double BeamLikelihood::density(double range_m, double expected_m) const {
  if (range_m < 0.0 || range_m >= max_range_m_) return 0.0;
  const double inside = share_inside(expected_m, params_.hit_deviation_m, max_range_m_);
  double density = hit_share() * normal_density(range_m - expected_m, params_.hit_deviation_m) / std::max(inside, 0.5);
  if (range_m <= expected_m && expected_m > 0.0) {
    const double normalizer = 1.0 / (1.0 - std::exp(-params_.short_per_m * expected_m));
    density += params_.short_share * normalizer * params_.short_per_m * std::exp(-params_.short_per_m * range_m);
  }
  return density + params_.random_share / max_range_m_;
}

std::int32_t BeamLikelihood::steps(double range_m, double expected_m) const {
  const double least = params_.random_share / max_range_m_;
  const double share = std::max(density(range_m, expected_m), least) / greatest_;
  return std::max(0, static_cast<std::int32_t>(std::lround(-std::log(share) / LikelihoodField::kStep)));
}

BeamModel::BeamModel(const OccupancyGrid& map, const BeamModelParams& params, double max_range_m)
    : geometry_{map.geometry()},
      likelihood_{params, max_range_m},
      max_range_m_{max_range_m},
      clear_cells_{clear_cells(map)} {}

double BeamModel::expected_range_m(const Point2& from, double direction_rad) const {
  // In cells; a step is as long as nothing can be in the way, so that free space costs few of them.
  const double cells_per_m = 1.0 / geometry_.resolution_m;
  const double max_cells = max_range_m_ * cells_per_m;
  const Point2 start = (from - geometry_.origin) * cells_per_m;
  const double c = std::cos(direction_rad);
  const double s = std::sin(direction_rad);
  for (double gone = 0.0; gone < max_cells;) {
    const double x = start.x() + gone * c;
    const double y = start.y() + gone * s;
    const bool inside = x >= 0.0 && y >= 0.0 && x < geometry_.width && y < geometry_.height;
    const int clear = inside ? clear_cells_[geometry_.index_of({static_cast<int>(x), static_cast<int>(y)})] : 0;
    if (clear == 0) return std::min((gone + kToSurfaceCells) / cells_per_m, max_range_m_);
    gone += std::max(kShortestStepCells, static_cast<double>(clear - 1));
  }
  return max_range_m_;
}

std::int32_t BeamModel::misfit_steps(const BeamEnds& ends, const Point2& robot_from_laser,
                                     const Pose2& map_from_robot) const {
  const Point2 from = map_from_robot * robot_from_laser;
  std::int32_t sum = 0;
  for (std::size_t i = 0; i < ends.size(); ++i) {
    const double x_m = static_cast<double>(ends.x_m[i]) - robot_from_laser.x();
    const double y_m = static_cast<double>(ends.y_m[i]) - robot_from_laser.y();
    const double direction_rad = map_from_robot.theta + std::atan2(y_m, x_m);
    sum += likelihood_.steps(std::hypot(x_m, y_m), expected_range_m(from, direction_rad));
  }
  return sum;
}

}  // namespace deltamap::localization
