// SPDX-License-Identifier: Apache-2.0
// Classifies the beams of one scan at the estimated pose by what the map expects there: a beam ends at a surface of the
// map (fit), before it (short) or beyond what the map has as an obstacle. The pose's covariance is taken into account:
// a beam that fits at some pose within it does not count against this one.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/grid/occupancy_grid.hpp"
#include "core/messages.hpp"
#include "localization/sensor/pose_refinement.hpp"

namespace deltamap::localization::belief {

enum class BeamFit : std::uint8_t {
  kSilent,  ///< no range, off the map, or too uncertain
  kFit,     ///< ended at a surface of the map
  kShort,   ///< ended in free space: something stands in the way
  kBeyond   ///< went through what the map has as an obstacle, for every pose within the covariance
};

struct CheckedBeam {
  BeamFit what = BeamFit::kSilent;
  Cell expected;            ///< the obstacle that the map expects the beam to end at
  Point2 normal{0.0, 0.0};  ///< of its surface, towards free space; zero where it has none
};

class BeamCheck {
 public:
  /// The chosen beams in order of bearing; valid until the next call.
  std::span<const CheckedBeam> check(const OccupancyGrid& map, const Scan& scan, std::span<const RayInRobot> rays,
                                     const sensor::RefinedPose& believed);

 private:
  std::vector<CheckedBeam> beams_;
};

}  // namespace deltamap::localization::belief
