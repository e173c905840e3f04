// SPDX-License-Identifier: Apache-2.0
#include "localization/sensor/transient_beams.hpp"

#include <cmath>

namespace deltamap::localization::sensor {

motion::BeamEnds lasting_ends(const motion::BeamEnds& ends, const TransientObstacles& transients,
                              const Pose2& map_from_robot, motion::BeamEnds others) {
  const double c = std::cos(map_from_robot.theta);  // once a scan, not once a beam
  const double s = std::sin(map_from_robot.theta);
  const auto lasts = [&](const Point2& end) {
    return !transients.stands_at({map_from_robot.x + c * end.x() - s * end.y(),  //
                                  map_from_robot.y + s * end.x() + c * end.y()});
  };
  motion::keep_ends(ends, lasts, others);
  return others;
}

}  // namespace deltamap::localization::sensor
