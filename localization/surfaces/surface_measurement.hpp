// SPDX-License-Identifier: Apache-2.0
// What the beams on one surface measure: how far it stands from where the map has it, and how it is turned.
#pragma once

#include "localization/surfaces/offset_state.hpp"
#include "localization/surfaces/surface_sighting.hpp"

namespace deltamap::localization::surfaces {

/// Where a surface stands, as seen from where the map has it, with variances.
struct SurfaceStand {
  double offset_m = 0.0;
  double turn_rad = 0.0;
  double offset_m2 = 0.0;
  double turn_rad2 = 0.0;
};

/// Two rows over the state of the filter; 0 is expected where pose, offset and turn are right.
struct SurfaceMeasurement {
  SparseRow distance;  ///< of the beams' mean from the surface, m
  SparseRow turn;      ///< of the beams' line against the surface's, rad
  double distance_m;
  double turn_rad;
  double distance_variance;
  double turn_variance;
  bool has_turn;   ///< false: the beams are too close to each other to tell
  double along_m;  ///< of the beams' mean from the surface's centre

  /// How far off it is with the surface standing there, with variances.
  [[nodiscard]] SurfaceStand off(const SurfaceStand& stand) const {
    return {distance_m - stand.offset_m - stand.turn_rad * along_m, turn_rad - stand.turn_rad,
            distance_variance + stand.offset_m2 + along_m * along_m * stand.turn_rad2, turn_variance + stand.turn_rad2};
  }
  /// The same in squared deviations.
  [[nodiscard]] double mahalanobis_squared(const SurfaceStand& stand) const {
    const SurfaceStand by = off(stand);
    const double by_turn = has_turn ? by.turn_rad * by.turn_rad / by.turn_rad2 : 0.0;
    return by.offset_m * by.offset_m / by.offset_m2 + by_turn;
  }
};

/// With the robot at `at`. `offset`: where the surface's offset stands in the state.
[[nodiscard]] SurfaceMeasurement measurement_of(const Sighting& sighting, const Pose2& at, Eigen::Index offset);

}  // namespace deltamap::localization::surfaces
