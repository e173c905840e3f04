// SPDX-License-Identifier: Apache-2.0
// The ends of a scan of a drawn world, as the localizer weighs them.
#pragma once

#include "localization/deskew.hpp"
#include "tests/support/cast_scan.hpp"

namespace deltamap::test {

/// All ends that a laser without motion sees from the pose, robot frame; the same each time.
[[nodiscard]] inline localization::BeamEnds cast_ends(const OccupancyGrid& world, const Pose2& map_from_robot,
                                                      const CastScanner& scanner = {}) {
  Random random{4};
  const Scan scan = cast_scan(world, map_from_robot, {}, scanner, random);
  return localization::scoring_ends(scan, localization::deskewed(scan, {}), 0);
}

}  // namespace deltamap::test
