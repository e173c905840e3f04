// SPDX-License-Identifier: Apache-2.0
// The inside of the localizer: which pose is believed, by a state machine of global, tracking and lost. Each scan is
// tracked (tracker.hpp) or searched for in the whole map (hypothesis_tracker.hpp) and then judged (judgement.hpp,
// fit_monitor.hpp). A hypothesis that wins is believed; a pose that is judged wrong is given up.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "localization/belief/stable_support.hpp"
#include "localization/hypotheses/hypothesis_tracker.hpp"
#include "localization/localizer.hpp"
#include "localization/localizer_params.hpp"
#include "localization/odometer/scan_witness.hpp"
#include "localization/sensor/range_scale.hpp"
#include "localization/surfaces/faced_scan.hpp"
#include "localization/tracking/tracker.hpp"

namespace deltamap::localization {

struct Localizer::State {
  State(const LocalizerParams& given, std::shared_ptr<const OccupancyGrid> first_map, std::uint64_t seed);

  LocalizerParams params;
  std::shared_ptr<const OccupancyGrid> map;
  std::uint32_t revision = 0;
  sensor::LikelihoodField field;
  motion::OdometryBuffer odometry;
  odometer::ScanWitness witness;
  tracking::Tracker tracker;
  belief::FitMonitor monitor;
  belief::Judgement judgement;
  hypotheses::HypothesisTracker hypotheses;
  particles::PoseCheck check;  ///< under way: particles around a pose that is not yet believed
  LocalizerCounts counts;
  motion::BeamEnds ends;
  surfaces::FaceFinder faces;                            ///< of the same scan
  motion::BodyVelocity velocity;                         ///< at the scan
  std::shared_ptr<const TransientObstacles> transients;  ///< that stand or are gone for now; may be null
  motion::BeamEnds ends_beside_transients;
  bool was_found = false;              ///< the believed pose, by a search: that it fits is all that speaks for it
  bool has_gone_through = false;       ///< the believed pose, through an obstacle of the map, and has not fitted since
  std::optional<Pose2> last_believed;  ///< at the last scan, while a pose was tracked
  std::optional<Timestamp> last_scan;
  std::optional<std::uint32_t> last_epoch;
  Pose2 last_odom;                       ///< odometry at the last scan
  std::optional<Timestamp> last_report;  ///< of the wheels
  double silence_s = 0.0;                ///< the longest between two of these since the last scan
  struct GivenUp {
    Pose2 map_from_robot;
    Pose2 continuous_odom_from_robot;
  };
  std::optional<GivenUp> given_up;          ///< where the robot was last believed to be, while a search has only begun
  particles::ParticleCluster best;          ///< of the particles, or the hypothesis that leads a search
  double w_avg = 1.0;                       ///< of that; before any scan nothing speaks against the pose
  std::size_t returned = 0;                 ///< beams of the newest scan that came back, mapped or not
  std::optional<double> newest_fit;         ///< explained_share() of the newest scan's mapped ends at the estimate
  std::optional<double> newest_fit_of_all;  ///< what that is of all beams that came back
  double n_eff = 0.0;                       ///< of the particles, or of a search's hypotheses
  belief::StableSupport stable_support;
  sensor::RangeScale range_scale;

  // How a pose comes to be believed, and ceases to be.
  void start_at(const particles::InitialPose& given);
  void start_anywhere();
  /// The particles stay where they are, but must prove themselves.
  void check_pose();
  /// The particles start anew around a hypothesis that has won.
  sensor::RefinedPose believe_in(const Pose2& hypothesis, const motion::ScanInstant& now);
  /// The robot is not where it was believed to be; before another pose is believed, the whole map is searched.
  void doubt(const Pose2& map_from_believed, const motion::ScanInstant& now);

  /// A report of the wheels: where scans have ceased to come, the particles go along with it.
  void take(const Odometry& report);

  // One scan, in this order.
  /// What the wheels tell at a scan, held against what the scan itself says of the motion.
  motion::ScanInstant witnessed(const Scan& scan, std::span<const RayInRobot> rays);
  double stood_m = 0.0;  ///< as TrackedScan::stood_m
  /// Before the scan is used: what is wrong with it, or with the time since the last one.
  void note_oddities(const motion::ScanInstant& now);
  /// While a given pose is believed: beams that the map says nothing about there. A pose that was carried, by all
  /// signs, is held against all beams, or it could hide where the map knows nothing; so is one that has gone through a
  /// wall.
  void leave_out_unmapped(const Point2& robot_from_laser, const motion::ScanInstant& now);
  sensor::RefinedPose believed(const motion::ScanInstant& now);
  void judge(const Scan& scan, std::span<const RayInRobot> rays, const motion::ScanInstant& now,
             const sensor::RefinedPose& believed);
  [[nodiscard]] Estimate estimate(Timestamp time, const sensor::RefinedPose& believed) const;

  // What these are made of.
  void start_tracking();
  /// The next scan is not read by the pose that was believed before.
  void forget_expected() {
    last_believed.reset();
    has_gone_through = false;
  }
  /// The hypothesis with the largest share, until it is believed. Over the first metres the pose that was given up:
  /// what has beaten it may be an alias of a pose that nobody has looked at yet.
  sensor::RefinedPose search(const motion::ScanInstant& now);
  sensor::RefinedPose track(const motion::ScanInstant& now);
  /// Those that weigh the believed pose: without what stands about for now, where enough are left.
  const motion::BeamEnds& weighing_ends(const motion::ScanInstant& now);
  /// The best pose that a slip may have led to and that explains at least this share of the ends; nothing without one.
  [[nodiscard]] std::optional<Pose2> explained_nearby(const Pose2& believed, double share) const;
  /// A hypothesis that holds nearly all belief, for long enough, and that explains the scan, or does so clearly better.
  [[nodiscard]] bool has_won(const hypotheses::ReportedHypothesis& hypothesis, const Pose2& believed) const;
  /// No pose is believed, nor one being checked.
  [[nodiscard]] bool searches() const;
  /// Is an obstacle of the map the first thing on the straight way that is not free?
  [[nodiscard]] bool meets_obstacle(const Point2& from, const Point2& to) const;
  /// At the last scan: most of what came back ended where the map knows nothing.
  [[nodiscard]] bool map_tells_little() const;
  /// The epoch of the odometry is another one than at the last scan.
  [[nodiscard]] bool has_jumped(const motion::ScanInstant& now) const;
  /// Do the wheels tell what has been driven since the last scan?
  [[nodiscard]] bool covers_the_gap(const motion::ScanInstant& now) const;
  [[nodiscard]] belief::FitMonitor::Observation passed_since_last_scan(const motion::ScanInstant& now) const;
  void judge_start(double fit);
  /// The monitor has changed its mind.
  void enter(LocalizerState after, LocalizerState before, const Pose2& believed, const motion::ScanInstant& now);
  [[nodiscard]] Pose2 continuous_odom_at(const motion::ScanInstant& now) const;
  /// The pose believed at the last scan, moved on by odometry.
  [[nodiscard]] std::optional<Pose2> expected_pose(const motion::ScanInstant& now) const;
};

}  // namespace deltamap::localization
