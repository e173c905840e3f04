// SPDX-License-Identifier: Apache-2.0
// Scores every shift of one map over another at once: contour and free space as a picture, correlated by Fourier
// transform.
#pragma once

#include <memory>
#include <span>
#include <vector>

#include "mapping/merge/overlay_score.hpp"

namespace deltamap::surveying::grid_registration {

class ShiftCorrelation {
 public:
  /// `map_contour`: of the map. `most_pixels` bounds the sides of the pictures: larger maps are shrunk by whole
  /// factors.
  ShiftCorrelation(const OccupancyGrid& map, std::span<const Cell> map_contour, const mapping::merge::LocalCells& local,
                   int least_cells_per_pixel, int most_pixels);
  ~ShiftCorrelation();
  ShiftCorrelation(const ShiftCorrelation&) = delete;
  ShiftCorrelation& operator=(const ShiftCorrelation&) = delete;

  /// The n best places for the local map's middle when turned so, best first, apart from each other; then the n best
  /// when turned half a turn farther, which cost little more.
  [[nodiscard]] std::vector<mapping::merge::CellMotion> best_shifts(double turn_rad, int n) const;
  /// Cells of the map that one pixel covers along each axis.
  [[nodiscard]] int cells_per_pixel() const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace deltamap::surveying::grid_registration
