// SPDX-License-Identifier: Apache-2.0
#include "localization/sensor/mapped_beams.hpp"

#include <algorithm>

#include "localization/sensor/straight_walk.hpp"

namespace deltamap::localization::sensor {
namespace {

constexpr double kMostReachM = 0.5;  // a room that is smaller than the doubt has to tell, too

}  // namespace

MappedBeams::MappedBeams(const OccupancyGrid& map, const LikelihoodField& field, const RefinedPose& about,
                         const Point2& robot_from_laser)
    : map_{map},
      field_{field},
      map_from_robot_{about.map_from_robot},
      laser_{about.map_from_robot * robot_from_laser},
      deviation_{pose_deviation(about.covariance)} {}

bool MappedBeams::tells_everywhere(const Point2& end) const {
  const double reach_m = std::min(kMostReachM, kBeamDeviations * deviation_.aside_m(end.norm()));
  return tells(end, {reach_m, 0.0}) && tells(end, {-reach_m, 0.0}) && tells(end, {0.0, reach_m}) &&
         tells(end, {0.0, -reach_m}) && tells(end);
}

bool MappedBeams::tells(const Point2& end, const Point2& shift) const {
  const Point2 from = laser_ + shift;
  const Point2 to = map_from_robot_ * end + shift;
  if (field_.steps_at(map_.geometry().cell_at(to)) < field_.even_steps()) return true;
  const double length_m = (to - from).norm();
  if (length_m <= kOutOfTheLaserM) return true;
  return first_met(map_, from, (to - from) / length_m, kOutOfTheLaserM, length_m).what != CellState::kUnknown;
}

}  // namespace deltamap::localization::sensor
