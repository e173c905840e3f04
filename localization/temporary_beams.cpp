// SPDX-License-Identifier: Apache-2.0
#include "localization/temporary_beams.hpp"

namespace deltamap::localization {

BeamEnds lasting_ends(const BeamEnds& ends, const TemporaryThings& things, const Pose2& map_from_robot,
                      BeamEnds others) {
  others.x_m.clear();
  others.y_m.clear();
  for (std::size_t i = 0; i < ends.size(); ++i) {
    const Point2 end_in_robot{ends.x_m[i], ends.y_m[i]};
    if (things.stands_at(map_from_robot * end_in_robot)) continue;
    others.x_m.push_back(ends.x_m[i]);
    others.y_m.push_back(ends.y_m[i]);
  }
  return others;
}

}  // namespace deltamap::localization
