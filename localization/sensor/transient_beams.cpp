// SPDX-License-Identifier: Apache-2.0
#include "localization/sensor/transient_beams.hpp"

#include "core/geometry/points_in_map.hpp"

namespace deltamap::localization::sensor {

motion::BeamEnds lasting_ends(const motion::BeamEnds& ends, const TransientObstacles& transients,
                              const Pose2& map_from_robot, motion::BeamEnds others) {
  const PointsInMap in_map{map_from_robot};
  const auto lasts = [&](const Point2& end) { return !transients.stands_at(in_map(end)); };
  motion::keep_ends(ends, lasts, others);
  return others;
}

}  // namespace deltamap::localization::sensor
