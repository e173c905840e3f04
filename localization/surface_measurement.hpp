// SPDX-License-Identifier: Apache-2.0
// What the beams on one surface measure: how far it stands from where the map has it, and how it is turned.
#pragma once

#include "localization/offset_state.hpp"
#include "localization/surface_sighting.hpp"

namespace deltamap::localization {

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

  /// How strange it is, in squared deviations, with the surface `offset_m` and `turn_rad` from where the map has it.
  [[nodiscard]] double strangeness(double offset_m, double turned_rad, double offset_variance,
                                   double turned_variance) const {
    const double off_m = distance_m - offset_m - turned_rad * along_m;
    const double off_rad = turn_rad - turned_rad;
    const double variance_m2 = distance_variance + offset_variance + along_m * along_m * turned_variance;
    const double by_turn = has_turn ? off_rad * off_rad / (turn_variance + turned_variance) : 0.0;
    return off_m * off_m / variance_m2 + by_turn;
  }
};

/// With the robot at `at`. `offset`: where the surface's offset stands in the state.
[[nodiscard]] SurfaceMeasurement measurement_of(const Sighting& sighting, const Pose2& at, Eigen::Index offset);

}  // namespace deltamap::localization
