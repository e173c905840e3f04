// SPDX-License-Identifier: Apache-2.0
#include "mapping/registration/from_pose.hpp"

#include <algorithm>
#include <cmath>

namespace deltamap::mapping::registration {

PoseCovariance floored(PoseCovariance covariance, const FromPoseParams& params) {
  const double position2 = params.least_position_deviation_m * params.least_position_deviation_m;
  covariance(0, 0) += position2;
  covariance(1, 1) += position2;
  covariance(2, 2) += params.least_heading_deviation_rad * params.least_heading_deviation_rad;
  return covariance;
}

double share_of_point(std::size_t points, const FromPoseParams& params) {
  return std::min(1.0, params.independent_points / std::max(1.0, static_cast<double>(points)));
}

RegistrationParams registration_params(std::size_t points, double resolution_m, const FromPoseParams& params) {
  return {.first_reach_m = params.reach_m,
          .last_reach_m = std::min(params.reach_m, std::max(0.12, 2.0 * resolution_m)),
          .point_deviation_m = params.surface_deviation_m / std::sqrt(share_of_point(points, params))};
}

}  // namespace deltamap::mapping::registration
