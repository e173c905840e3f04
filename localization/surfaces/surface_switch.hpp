// SPDX-License-Identifier: Apache-2.0
// Does a surface stand where the map has it, or was it moved? A binary switch beside the Gaussian. Its effect on the
// surface's offset is passed on by expectation propagation (Minka 2001) and can be revised for as long as the surface
// is followed. Pieces of one straight face that are off alike count as one observation.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "localization/sensor/scan_segments.hpp"
#include "localization/surfaces/offset_state.hpp"
#include "localization/surfaces/surface.hpp"

namespace deltamap::localization::surfaces {

/// Driven between two keyframes: what is in view is looked for that often.
inline constexpr double kKeyframeM = 0.2;
/// Driven without a view of a surface: it is followed until then.
inline constexpr double kForgottenAfterM = 15.0;
/// Deviation of the bearing of a surface that was moved, about where it stood; that of its offset is kMovedM.
inline constexpr double kMovedRad = 0.1;

struct SurfaceSwitch {
  Surface surface;
  double usual_m = 0.0;                  ///< its offset while it holds
  double prior = sensor::kUsuallyHolds;  ///< P(holds) before it was in view
  double holds = 0.5;                    ///< P(holds) now
  double share = 1.0;                    ///< of what its face tells, that is one observation in several pieces
  double unseen_m = 0.0;                 ///< driven since it was last in view
  /// What the switch adds to the Gaussian: precision and precision · mean of offset and turn.
  Eigen::Matrix2d precision = Eigen::Matrix2d::Zero();
  Eigen::Vector2d pull = Eigen::Vector2d::Zero();
};

/// Settles all switches against each other; `switches[i]` is that of surface i of the state.
void settle(std::vector<SurfaceSwitch>& switches, OffsetState& state);

}  // namespace deltamap::localization::surfaces
