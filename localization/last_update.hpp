// SPDX-License-Identifier: Apache-2.0
// The last scan that changed the particles, and what has moved since.
#pragma once

#include <optional>

#include "core/time.hpp"
#include "localization/odometry_buffer.hpp"
#include "localization/pose_refinement.hpp"

namespace deltamap::localization {

struct LastUpdate {
  Timestamp time;
  std::optional<OdometryAt> odometry;
  RefinedPose believed;
  double n_eff = 0.0;
};

struct MotionSince {
  Pose2 motion;
  double unknown_s = 0.0;  ///< not covered by odometry
  double passed_s = 0.0;
};

/// `usual_s`: between two updates; more than twice that is a silence, in which the wheels may have turned unseen where
/// the epoch has changed too.
[[nodiscard]] MotionSince motion_since(const LastUpdate& last, Timestamp time, const std::optional<OdometryAt>& now,
                                       double usual_s);

}  // namespace deltamap::localization
