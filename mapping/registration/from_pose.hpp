// SPDX-License-Identifier: Apache-2.0
// Registration onto a grid's surfaces from a pose that a localizer has told: how sure that pose can be, and how much
// points on a grid's surfaces tell.
#pragma once

#include <cstddef>

#include "core/geometry/pose2.hpp"
#include "mapping/registration/registration.hpp"

namespace deltamap::mapping::registration {

struct FromPoseParams {
  double reach_m = 0.3;                         ///< points farther from every surface of the map do not count
  double surface_deviation_m = 0.04;            ///< spread of a hit around a surface of the map; > 0
  double least_position_deviation_m = 0.03;     ///< floor of the pose's σ: particle filters are too sure of themselves
  double least_heading_deviation_rad = 0.0087;  ///< floor of the heading's σ (0.5°)
  double independent_points = 60.0;  ///< at most so many points' worth of information: cell noise is shared; > 0
};

[[nodiscard]] PoseCovariance floored(PoseCovariance covariance, const FromPoseParams& params);
/// How much of its information each of so many points counts, (0, 1].
[[nodiscard]] double share_of_point(std::size_t points, const FromPoseParams& params);
[[nodiscard]] RegistrationParams registration_params(std::size_t points, double resolution_m,
                                                     const FromPoseParams& params);

}  // namespace deltamap::mapping::registration
