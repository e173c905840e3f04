// SPDX-License-Identifier: Apache-2.0
// The time of a scan with the odometry at that time, and the motion between two such instants.
#pragma once

#include <optional>

#include "core/time.hpp"
#include "localization/motion/odometry_buffer.hpp"

namespace deltamap::localization::motion {

struct ScanInstant {
  Timestamp time;
  std::optional<OdometryAt> odometry;
};

struct MotionSince {
  Pose2 motion;
  double unknown_s = 0.0;    ///< not covered by odometry
  MotionVariance slipped{};  ///< where the scans have corrected the wheels: what they leave open
  double passed_s = 0.0;
  bool by_scans = false;  ///< all along: `slipped` is all that is unsure
};

/// `usual_s`: between two updates; more than twice that is a silence, in which the wheels may have turned unseen where
/// the epoch has changed too.
[[nodiscard]] MotionSince motion_since(const ScanInstant& last, const ScanInstant& now, double usual_s);

/// What the wheels counted, their systematic errors included; across two epochs without them, as nothing else joins
/// these.
[[nodiscard]] Pose2 counted_between(const ScanInstant& before, const ScanInstant& now);

/// From one scan to the next: where the epoch has changed, nothing is known of what passed between.
[[nodiscard]] MotionSince step_between(const ScanInstant& before, const ScanInstant& now);

}  // namespace deltamap::localization::motion
