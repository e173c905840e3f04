// SPDX-License-Identifier: Apache-2.0
// Tracks the believed pose by surfaces, as one Gaussian: predicted by the calibrated wheels, corrected at keyframes by
// the surfaces in view (offset_filter.hpp). It leads where straight surfaces explain the scans, and the particles rest
// meanwhile; where they cease to, the particles go on from its pose.
#pragma once

#include <memory>
#include <optional>
#include <span>

#include "localization/motion/motion_model.hpp"
#include "localization/motion/scan_instant.hpp"
#include "localization/surfaces/offset_filter.hpp"
#include "localization/tracking/odometry_noise.hpp"
#include "localization/tracking/seen_scan.hpp"

namespace deltamap::localization::tracking {

class SurfaceTracker {
 public:
  /// `evidence_beams`: as of ParticleFilterParams.
  SurfaceTracker(const OdometryNoiseParams& wheels, const motion::MotionModelParams& motion, double evidence_beams,
                 std::shared_ptr<const OccupancyGrid> map);

  void apply(std::shared_ptr<const OccupancyGrid> map, const CellBox& changed);

  /// Is a pose sure enough to tell the surfaces around it apart?
  [[nodiscard]] static bool is_one_place(const PoseCovariance& spread);

  [[nodiscard]] bool leads() const { return leads_; }
  /// Looks at a scan while the particles lead. True where straight surfaces have explained the scans of late.
  [[nodiscard]] bool could_lead(const SeenScan& seen, const Pose2& map_from_robot);
  /// The particles lead: how the wheels err is learned from where they find the robot.
  void learn_from(const sensor::RefinedPose& found, const motion::ScanInstant& now,
                  const motion::BodyVelocity& velocity);
  /// Leads from here on.
  sensor::RefinedPose lead_from(const sensor::RefinedPose& at, const SeenScan& seen);
  /// The pose was set, or the particles have taken over.
  void cease() {
    leads_ = false;
    last_.reset();
    unknown_by_map_ = {};
  }

  /// The pose at one more scan. It may have ceased to lead.
  sensor::RefinedPose observe(const SeenScan& seen);
  /// No scan tells of the pose: predicts by the calibrated wheels. None where no scan came before.
  std::optional<sensor::RefinedPose> predict(const motion::ScanInstant& now);

  /// Before the first scan: what an earlier run has learned.
  void restore(const motion::DriveCalibration& learned) { filter_.restore(learned); }
  [[nodiscard]] motion::DriveCalibration calibration() const { return filter_.calibration(); }
  /// What the cells of the surfaces in view leave open of the position; where it leads, of those of the last metres.
  [[nodiscard]] surfaces::UnknownOfCells unknown_of_cells() const;
  /// It leads, and surfaces that stand where the map has them fix the pose, or did so a few metres ago.
  [[nodiscard]] bool is_fixed_by_surfaces() const;

 private:
  struct Last {
    motion::ScanInstant instant;
    motion::BodyVelocity velocity;
  };
  [[nodiscard]] PoseCovariance noise(const Pose2& motion, const motion::MotionSince& step) const;
  void step_to(const motion::ScanInstant& now, const motion::BodyVelocity& velocity);
  [[nodiscard]] bool has_moved() const;  ///< far enough since the last keyframe for another
  [[nodiscard]] bool is_due(const SeenScan& seen) const;
  sensor::RefinedPose keyframe(const SeenScan& seen);
  void note_held(const surfaces::OffsetFilter::Seen& shown);
  void learn_noise(const sensor::RefinedPose& before, const sensor::RefinedPose& after);

  motion::MotionModelParams motion_;
  OdometryNoiseEstimator odometry_noise_;
  double evidence_beams_;
  surfaces::OffsetFilter filter_;
  std::optional<Last> last_;
  bool leads_ = false;
  struct SinceKeyframe {
    Pose2 by_wheels;
    Pose2 corrected;
    bool wheels_told = true;    // of all of the way
    bool contradicted = false;  // the wheels, by the scans
    double explained = 0.0;     // share of the keyframe's ends, by the map
  };
  std::optional<SinceKeyframe> since_;       // none: no keyframe yet
  surfaces::UnknownOfCells unknown_by_map_;  // while the particles lead: by the last scan
  double straight_ = 0.0;  // share of ends: running mean over keyframes, over scans while the particles lead
  double holding_ = 0.0;   // share of ends: running mean over keyframes
  double since_held_m_ = surfaces::kForgottenAfterM;  // driven since surfaces held the pose; they have followed it
  double surprise_m_ = 1.0;  // squared corrections as multiples of what was expected, running means
  double surprise_rad_ = 1.0;
};

}  // namespace deltamap::localization::tracking
