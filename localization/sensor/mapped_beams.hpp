// SPDX-License-Identifier: Apache-2.0
// Which beams the map has anything to say about. Where a beam leaves what the map knows before it meets an obstacle,
// its end speaks neither for nor against the pose: a robot that drives into a room that was never mapped is not lost.
#pragma once

#include "core/geometry/pose_spread.hpp"
#include "core/grid/occupancy_grid.hpp"
#include "core/messages.hpp"
#include "localization/sensor/likelihood_field.hpp"
#include "localization/sensor/pose_refinement.hpp"

namespace deltamap::localization::sensor {

/// Of one scan, with the robot about a pose. Map and field must live as long.
class MappedBeams {
 public:
  MappedBeams(const OccupancyGrid& map, const LikelihoodField& field, const RefinedPose& about,
              const Point2& robot_from_laser);

  /// `end`: of a beam, robot frame, m. An end that a contour explains always tells.
  [[nodiscard]] bool tells(const Point2& end) const { return tells(end, {0.0, 0.0}); }
  /// Whether it tells at all poses within two deviations, half a metre at most. One that tells at some of them alone
  /// would pull the pose to these: to where a wall that goes on beyond the known map is known.
  [[nodiscard]] bool tells_everywhere(const Point2& end) const;

 private:
  [[nodiscard]] bool tells(const Point2& end, const Point2& shift) const;

  const OccupancyGrid& map_;
  const LikelihoodField& field_;
  Pose2 map_from_robot_;
  Point2 laser_;
  PoseDeviation deviation_;
};

}  // namespace deltamap::localization::sensor
