// SPDX-License-Identifier: Apache-2.0
// Tracks one believed pose from scan to scan: particles are moved, weighed and resampled at an update, the pose filter
// predicts in between, and each scan refines the pose. It knows no other hypotheses and does not ask whether the pose
// is right (hypothesis_tracker.hpp, judgement.hpp).
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <span>

#include "core/geometry/angle.hpp"
#include "localization/motion/drive_calibration.hpp"
#include "localization/motion/scan_instant.hpp"
#include "localization/particles/particle_clusters.hpp"
#include "localization/particles/particle_filter.hpp"
#include "localization/particles/start_pose.hpp"
#include "localization/sensor/pose_refinement.hpp"
#include "localization/tracking/pose_filter.hpp"
#include "localization/tracking/seen_scan.hpp"
#include "localization/tracking/slip_finder.hpp"

namespace deltamap::localization::tracking {

class SurfaceTracker;

/// When a scan changes the particles' weights. In between the estimate follows odometry and refinement alone, so that a
/// robot that stands still does not talk itself into certainty.
struct UpdateParams {
  double distance_m = 0.05;        ///< driven since the last update, m; >= 0
  double turn_rad = radians(2.0);  ///< turned since the last update, rad; >= 0
  double time_s = 1.0;             ///< passed since the last update, s; > 0
};

struct TrackerParams {
  particles::ParticleFilterParams particles;
  motion::MotionModelParams motion;
  sensor::RefinementParams refinement;
  OdometryNoiseParams wheels;
  UpdateParams update;
  bool follow_surfaces = true;  ///< where straight surfaces explain the scans they lead, and the particles rest
};

class Tracker {
 public:
  Tracker(const TrackerParams& params, std::shared_ptr<const OccupancyGrid> map, std::uint64_t seed);
  ~Tracker();

  /// Another map, the same but for a box of cells.
  void apply(std::shared_ptr<const OccupancyGrid> map, const CellBox& changed);

  /// All that came before is forgotten. Answers what is believed before a scan is read.
  sensor::RefinedPose start_around(const particles::InitialPose& pose);
  /// As start_around(), at a scan: the motion from there on counts.
  sensor::RefinedPose start_around(const particles::InitialPose& pose, const motion::ScanInstant& now);
  /// The clock of the scans has fallen back to this time.
  void restart_clock(Timestamp time);

  struct Answer {
    sensor::RefinedPose believed;
    std::optional<double> w_avg;  ///< mean likelihood over the believed particles (paper §3.1); none without a return
    std::optional<double> n_eff;  ///< where the scan was an update; while surfaces lead the number of particles
    double unknown_s = 0.0;       ///< since the last update, not covered by odometry
    bool looked_around =
        false;  ///< the pose was open by more than one place after a silence; the scan was looked for in it
  };
  Answer observe(const SeenScan& seen);
  /// No scan has come for long: particles and pose filter are predicted by the wheels up to this instant.
  void predict(const motion::ScanInstant& now);

  /// Nothing where surfaces are not followed. A scan's mount is to be corrected by it before the scan is seen.
  [[nodiscard]] std::optional<motion::DriveCalibration> calibration() const;
  /// Before the first scan: what an earlier run has learned.
  void restore(const motion::DriveCalibration& learned);
  /// What the believed pose's covariance does not count in.
  struct NotCounted {
    /// Of the particles what is not known of the laser's mount, of the surfaces what the map's cells leave open beyond
    /// the covariance, each face off in its own way.
    PoseCovariance noise = PoseCovariance::Zero();
    /// What all scans are off by alike, as the map's surfaces are. Of the particles all that cells leave open.
    PoseCovariance bias = PoseCovariance::Zero();
  };
  [[nodiscard]] NotCounted not_counted_in(const sensor::RefinedPose& believed) const;
  /// Surfaces that stand where the map has them fix the pose; never while the particles lead.
  [[nodiscard]] bool is_fixed_by_surfaces() const;

  /// The heaviest cluster of particles at the last update.
  [[nodiscard]] const particles::ParticleCluster& best() const { return best_; }
  /// As of the last update; null while the surfaces lead: the particles rest then, somewhere behind.
  [[nodiscard]] const particles::ParticleSet* particles() const;
  [[nodiscard]] std::size_t particle_count() const { return filter_.particles().size(); }

 private:
  Answer update(const SeenScan& seen, const motion::MotionSince& since);
  bool gather(const SeenScan& seen);
  bool start_within(const sensor::RefinedPose& prior, const SeenScan& seen);
  Answer follow(const SeenScan& seen, const motion::MotionSince& since);
  Answer led_by_surfaces(const SeenScan& seen);
  sensor::RefinedPose start_around(const sensor::RefinedPose& pose);
  [[nodiscard]] std::size_t particles_for(const PoseCovariance& spread) const;
  void let_surfaces_lead(const SeenScan& seen, Answer& answer);
  [[nodiscard]] motion::MotionModelParams noise_of(const motion::MotionSince& since) const;
  [[nodiscard]] bool update_due(const motion::MotionSince& since) const;
  [[nodiscard]] std::span<const Pose2> slips(const SeenScan& seen);
  [[nodiscard]] double beam_share(const SeenScan& seen) const;
  [[nodiscard]] double mean_over_members(std::span<const std::int32_t> misfits, std::size_t beams) const;
  [[nodiscard]] double mean_over_some_members(const SeenScan& seen, const Pose2& motion) const;
  [[nodiscard]] sensor::RefinedPose refined(const SeenScan& seen, const sensor::RefinedPose& prior);
  void draw_anew_if_needed();

  TrackerParams params_;
  particles::ParticleFilter filter_;
  PoseFilter pose_filter_;
  std::unique_ptr<SurfaceTracker> surfaces_;  // none: they never lead
  particles::ParticleClusterFinder clusters_;
  particles::ParticleCluster best_;
  sensor::BeamErrors errors_;
  SlipFinder slip_finder_;
  std::optional<motion::ScanInstant> last_update_;
  bool has_driven_blind_ = false;  ///< the particles have moved, or the surfaces' pose, since the last scan that came
  bool drawn_anew_ = false;        ///< the particles, so that `clusters_` must look at them again
};

}  // namespace deltamap::localization::tracking
