// SPDX-License-Identifier: Apache-2.0
// Brings each scan of an S(k) onto the part of the map that is not in doubt, starting at the localizer's pose and held
// by its covariance. A scan whose pose would have to move farther than its covariance allows (χ²) is left out.
#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include "core/messages.hpp"
#include "core/occupancy_grid.hpp"
#include "core/pose_spread.hpp"
#include "mapping/redraw/placed_scan.hpp"

namespace deltamap::mapping::redraw {

struct PlacementParams {
  double reach_m = 0.3;                         ///< points farther from every surface of the map do not count
  double surface_deviation_m = 0.04;            ///< spread of a hit around a surface of the map; > 0
  double longest_m = 10.0;                      ///< beams beyond do not count
  double least_position_deviation_m = 0.03;     ///< floor of the pose's σ: particle filters are too sure of themselves
  double least_heading_deviation_rad = 0.0087;  ///< floor of the heading's σ (0.5°)
  double independent_points = 60.0;             ///< at most so many points' worth of information: cell noise is shared
  std::uint32_t least_points = 30;              ///< with fewer near a surface the localizer's pose stays
  double least_agreement = 0.5;                 ///< share of the points near a surface that come to lie on it; [0, 1]
  double most_chi2 = kMostChi2;                 ///< of a correction under the pose's covariance
};

struct Placement {
  std::vector<PlacedScan> scans;  ///< those that fit, pointing to those of the set
  std::uint32_t implausible = 0;  ///< left out: they contradict the localizer, or do not fit
};

/// `is_in_doubt(cell)`: surfaces there do not count.
[[nodiscard]] Placement placed_scans(const OccupancyGrid& map, const KeptScans& scans,
                                     const std::function<bool(Cell)>& is_in_doubt, const PlacementParams& params);

}  // namespace deltamap::mapping::redraw
