// SPDX-License-Identifier: Apache-2.0
#include "localization/surfaces/surface_measurement.hpp"

#include <algorithm>

namespace deltamap::localization::surfaces {
namespace {

constexpr double kDistanceFloorM = 0.01;  // what all beams on one surface err together
constexpr double kSlopeFloorRad = 0.004;
constexpr double kLeastSpreadM2 = 0.02;  // of the ends along a surface, for its direction to be told

}  // namespace

SurfaceMeasurement measurement_of(const Sighting& sighting, const Pose2& at, Eigen::Index offset) {
  const Sighting::Measured seen = sighting.measured(at);
  const Point2& n = sighting.surface.normal;
  const double by_turn_m = n.y() * seen.lever.x() - n.x() * seen.lever.y();
  // The mount errs in the robot's directions.
  const Point2 in_robot = Pose2{0.0, 0.0, -at.theta} * n;
  const double beam2 = std::max(sighting.range_deviation_m * sighting.range_deviation_m,
                                seen.across_m2 / std::max(1.0, sighting.beams - 2.0));
  return {.distance = {{{{0, n.x()},
                         {1, n.y()},
                         {2, by_turn_m},
                         {OffsetState::kMount, in_robot.x()},
                         {OffsetState::kMount + 1, in_robot.y()},
                         {OffsetState::kMount + 2, by_turn_m},
                         {offset, -1.0},
                         {offset + 1, -seen.along_m}}},
                       8},
          .turn = {{{{2, -1.0}, {OffsetState::kMount + 2, -1.0}, {offset + 1, -1.0}}}, 3},
          .distance_m = seen.distance_m,
          .turn_rad = seen.slope,
          .distance_variance = beam2 / sighting.beams + kDistanceFloorM * kDistanceFloorM +
                               sighting.corner_deviation_m * sighting.corner_deviation_m,
          .turn_variance = beam2 / std::max(1e-6, seen.spread_m2) + kSlopeFloorRad * kSlopeFloorRad,
          .has_turn = seen.spread_m2 > kLeastSpreadM2,
          .along_m = seen.along_m};
}

}  // namespace deltamap::localization::surfaces
