// SPDX-License-Identifier: Apache-2.0
#include "localization/sensor/transient_beams.hpp"

#include <cmath>

namespace deltamap::localization::sensor {

motion::BeamEnds lasting_ends(const motion::BeamEnds& ends, const TransientObstacles& transients,
                              const Pose2& map_from_robot, motion::BeamEnds others) {
  others.x_m.clear();
  others.y_m.clear();
  const double c = std::cos(map_from_robot.theta);  // once a scan, not once a beam
  const double s = std::sin(map_from_robot.theta);
  for (std::size_t i = 0; i < ends.size(); ++i) {
    const double x_m = ends.x_m[i];
    const double y_m = ends.y_m[i];
    if (transients.stands_at({map_from_robot.x + c * x_m - s * y_m, map_from_robot.y + s * x_m + c * y_m})) continue;
    others.x_m.push_back(ends.x_m[i]);
    others.y_m.push_back(ends.y_m[i]);
  }
  return others;
}

}  // namespace deltamap::localization::sensor
