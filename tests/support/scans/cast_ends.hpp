// SPDX-License-Identifier: Apache-2.0
// The ends of a scan of a drawn world, as the localizer weighs them.
#pragma once

#include "localization/motion/deskew.hpp"
#include "tests/support/scans/cast_scan.hpp"

namespace deltamap::test {

/// The ends that a laser without motion sees from the pose, robot frame; of so many beams, 0: of all.
[[nodiscard]] inline localization::motion::BeamEnds cast_ends(const OccupancyGrid& world, const Pose2& map_from_robot,
                                                              const CastScanner& scanner, Random& random,
                                                              int beams = 0) {
  const Scan scan = cast_scan(world, map_from_robot, {}, scanner, random);
  return localization::motion::scoring_ends(scan, localization::motion::deskewed(scan, {}), beams);
}

/// All of them; the same each time.
[[nodiscard]] inline localization::motion::BeamEnds cast_ends(const OccupancyGrid& world, const Pose2& map_from_robot,
                                                              const CastScanner& scanner = {}) {
  Random random{4};
  return cast_ends(world, map_from_robot, scanner, random);
}

}  // namespace deltamap::test
