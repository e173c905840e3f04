// SPDX-License-Identifier: Apache-2.0
// How far every point of a map is from its nearest obstacle, and how deep it lies in what is not free floor. Tables of
// one byte a cell, for those who ask very often.
#pragma once

#include <cstdint>
#include <vector>

#include "core/grid/occupancy_grid.hpp"

namespace deltamap::experiments {

class MapDistances {
 public:
  static constexpr float kMost_m = 3.0F;  ///< no distance is told beyond this

  explicit MapDistances(const OccupancyGrid& map);

  /// From the middle of the point's cell to that of the nearest obstacle; kMost_m outside the map.
  [[nodiscard]] float to_obstacle_m(float x_m, float y_m) const { return at(to_obstacle_, x_m, y_m); }
  /// To the nearest cell of free floor: 0 on it; kMost_m outside the map.
  [[nodiscard]] float to_floor_m(float x_m, float y_m) const { return at(to_floor_, x_m, y_m); }

  [[nodiscard]] const GridGeometry& geometry() const { return geometry_; }

 private:
  using Table = std::vector<std::uint8_t>;
  static constexpr float kUnit_m = 0.0125F;

  [[nodiscard]] float at(const Table& table, float x_m, float y_m) const {
    const float column = (x_m - low_x_m_) * cells_a_metre_;
    const float row = (y_m - low_y_m_) * cells_a_metre_;
    if (!(column >= 0.0F && row >= 0.0F && column < columns_ && row < rows_)) return kMost_m;
    return kUnit_m * static_cast<float>(table[static_cast<std::size_t>(static_cast<int>(row)) * stride_ +
                                              static_cast<std::size_t>(static_cast<int>(column))]);
  }
  [[nodiscard]] Table distances(const OccupancyGrid& map, CellState to) const;

  GridGeometry geometry_;
  float low_x_m_;
  float low_y_m_;
  float cells_a_metre_;
  float columns_;
  float rows_;
  std::size_t stride_;
  Table to_obstacle_;
  Table to_floor_;
};

}  // namespace deltamap::experiments
