// SPDX-License-Identifier: Apache-2.0
// Brings each scan of an S(k) onto the part of the map that is not in doubt, starting at the localizer's pose and held
// by its covariance. A scan whose pose would have to move farther than its covariance allows (χ²) is left out.
#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include "core/grid/occupancy_grid.hpp"
#include "core/messages.hpp"
#include "mapping/redraw/placed_scan.hpp"
#include "mapping/registration/from_pose.hpp"

namespace deltamap::mapping::redraw {

struct PlacementParams : registration::FromPoseParams {
  double longest_m = 10.0;          ///< beams beyond do not count
  std::uint32_t least_points = 30;  ///< with fewer near a surface the localizer's pose stays
  double least_agreement = 0.5;     ///< share of the points near a surface that come to lie on it; [0, 1]
};

struct Placement {
  std::vector<PlacedScan> scans;  ///< those that fit, pointing to those of the set
  std::uint32_t implausible = 0;  ///< left out: they contradict the localizer, or do not fit
};

/// `is_in_doubt(cell)`: surfaces there do not count.
[[nodiscard]] Placement placed_scans(const OccupancyGrid& map, const KeptScans& scans,
                                     const std::function<bool(Cell)>& is_in_doubt, const PlacementParams& params);

}  // namespace deltamap::mapping::redraw
