// SPDX-License-Identifier: Apache-2.0
// The estimate from scan to scan: carried along by the wheels, with an error that grows as the wheels have earned,
// until the next scan corrects it. The particles overrule it where they disagree.
#pragma once

#include <optional>

#include "localization/motion/motion_model.hpp"
#include "localization/motion/scan_instant.hpp"
#include "localization/particles/hypotheses.hpp"
#include "localization/sensor/pose_refinement.hpp"
#include "localization/tracking/wheel_trust.hpp"

namespace deltamap::localization::tracking {

struct PoseTrackParams {
  double agreement =
      3.0;  ///< deviations of the particles within which the track goes on; beyond it they are right; > 0
  WheelTrustParams wheels;
};

class PoseTrack {
 public:
  PoseTrack(const PoseTrackParams& params, const motion::MotionModelParams& motion)
      : params_{params}, motion_{motion}, wheels_{params.wheels} {}

  /// The pose was set, not driven to.
  void forget();

  /// What is known of the pose at a scan before the scan is read: the last estimate, carried by the wheels, or the
  /// particles' own where they disagree or nothing came before.
  [[nodiscard]] sensor::RefinedPose before_scan(const motion::ScanInstant& now, const particles::Hypothesis& particles);

  /// The last estimate, carried by the wheels; none after forget().
  [[nodiscard]] std::optional<Pose2> carried_to(const motion::ScanInstant& now) const;

  /// Goes along with the wheels where no scan tells how good they are.
  void carry(const motion::ScanInstant& now);

  /// What the scan made of it.
  void after_scan(const motion::ScanInstant& now, const sensor::RefinedPose& believed);

  /// The noise for the particles: what the wheels have shown, with a margin; never more than was set.
  [[nodiscard]] motion::MotionModelParams particle_motion() const;

 private:
  struct Last {
    motion::ScanInstant instant;
    sensor::RefinedPose believed;
  };
  /// The last estimate, carried by the wheels, and as unsure as they are.
  [[nodiscard]] sensor::RefinedPose expected_at(const motion::ScanInstant& now) const;

  PoseTrackParams params_;
  motion::MotionModelParams motion_;
  WheelTrust wheels_;
  std::optional<Last> last_;
};

}  // namespace deltamap::localization::tracking
