// SPDX-License-Identifier: Apache-2.0
// A Kalman filter of the believed pose from scan to scan. Prediction: the motion that the wheels counted, with the
// noise that OdometryNoiseEstimator has learned. Correction: the pose that the scan was refined to. Where the particles
// disagree by more than their spread explains, their pose is taken in its place.
#pragma once

#include <optional>

#include "localization/motion/motion_model.hpp"
#include "localization/motion/scan_instant.hpp"
#include "localization/particles/particle_clusters.hpp"
#include "localization/sensor/pose_refinement.hpp"
#include "localization/tracking/odometry_noise.hpp"

namespace deltamap::localization::tracking {

class PoseFilter {
 public:
  PoseFilter(const OdometryNoiseParams& wheels, const motion::MotionModelParams& motion)
      : motion_{motion}, odometry_noise_{wheels} {}

  /// The pose was set, not driven to.
  void forget();

  /// What is known of the pose at a scan before the scan is read: the last estimate, predicted by the wheels, or the
  /// particles' own where they disagree or nothing came before.
  [[nodiscard]] sensor::RefinedPose before_scan(const motion::ScanInstant& now,
                                                const particles::ParticleCluster& particles);

  /// The last estimate, predicted by the wheels; none after forget().
  [[nodiscard]] std::optional<Pose2> predicted_at(const motion::ScanInstant& now) const;

  /// Predicts by the wheels where no scan corrects.
  void predict(const motion::ScanInstant& now);

  /// What the scan made of it.
  void after_scan(const motion::ScanInstant& now, const sensor::RefinedPose& believed);

  /// The noise for the particles: what the wheels have shown, with a margin; never more than was set.
  [[nodiscard]] motion::MotionModelParams particle_motion() const;

 private:
  struct Last {
    motion::ScanInstant instant;
    sensor::RefinedPose believed;
  };
  /// The last estimate, predicted by the wheels, and as unsure as they are.
  [[nodiscard]] sensor::RefinedPose expected_at(const motion::ScanInstant& now) const;

  motion::MotionModelParams motion_;
  OdometryNoiseEstimator odometry_noise_;
  std::optional<Last> last_;
};

}  // namespace deltamap::localization::tracking
