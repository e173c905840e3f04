// SPDX-License-Identifier: Apache-2.0
// The inside of the localizer: which pose is believed, by a state machine of global, tracking and lost. A scan is
// followed by the particles (tracker.hpp) or searched for in the whole map (rivals.hpp), then judged (judgement.hpp,
// fit_monitor.hpp); what wins is believed, what is judged wrong is given up.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "localization/localizer.hpp"
#include "localization/localizer_params.hpp"
#include "localization/proven_hold.hpp"

namespace deltamap::localization {

struct Localizer::State {
  State(const LocalizerParams& given, std::shared_ptr<const OccupancyGrid> first_map, std::uint64_t seed);

  LocalizerParams params;
  std::shared_ptr<const OccupancyGrid> map;
  std::uint32_t revision = 0;
  LikelihoodField field;
  OdometryBuffer odometry;
  Tracker tracker;
  FitMonitor monitor;
  Judgement judgement;
  Rivals rivals;
  PoseCheck check;  ///< under way: particles around a pose that is not yet believed
  LocalizerCounts counts;
  BeamEnds ends;
  std::vector<FacedEnd> faced;                    ///< the same scan's, where surfaces are followed
  BodyVelocity velocity;                          ///< at the scan
  std::shared_ptr<const TemporaryThings> things;  ///< that stand or are gone for now; may be null
  BeamEnds ends_beside_things;
  std::optional<Pose2> last_believed;  ///< at the last scan, while a pose was tracked
  std::optional<Timestamp> last_scan;
  std::optional<std::uint32_t> last_epoch;
  Pose2 last_joined;                     ///< odometry at the last scan
  std::optional<Timestamp> last_report;  ///< of the wheels
  double silence_s = 0.0;                ///< the longest between two of these since the last scan
  struct GivenUp {
    Pose2 map_from_robot;
    Pose2 joined_from_robot;
  };
  std::optional<GivenUp> given_up;   ///< where the robot was last believed to be, while a search has only begun
  Hypothesis best;                   ///< of the particles, or the place that leads a search
  double w_avg = 1.0;                ///< of that; before any scan nothing speaks against the pose
  std::optional<double> newest_fit;  ///< explained_share() of the newest scan at the estimate
  double n_eff = 0.0;                ///< of the particles, or of a search's places
  ProvenHold proven_hold;

  // How a pose comes to be believed, and ceases to be.
  void start_at(const InitialPose& given);
  void start_anywhere();
  /// The particles stay where they are, but must prove themselves.
  void check_pose();
  /// The particles start anew around a place that has won.
  RefinedPose believe_in(const Pose2& place, const ScanInstant& now);
  /// The robot is not where it was believed to be; before another place is believed, the whole map is searched.
  void doubt(const Pose2& map_from_believed, const ScanInstant& now);

  /// A report of the wheels: where scans have ceased to come, the particles go along with it.
  void take(const Odometry& report);

  // One scan, in this order.
  /// Before the scan is used: what is wrong with it, or with the time since the last one.
  void note_oddities(const ScanInstant& now);
  RefinedPose believed(const ScanInstant& now);
  void judge(const Scan& scan, std::span<const RayInRobot> rays, const ScanInstant& now, const RefinedPose& believed);
  [[nodiscard]] Estimate estimate(Timestamp time, const RefinedPose& believed) const;

  // What these are made of.
  void start_tracking();
  /// The best place that has come to mind leads, until it is believed; at first, what has been given up: the place that
  /// has beaten it may be the image of one that nobody has looked at yet.
  RefinedPose search(const ScanInstant& now);
  RefinedPose track(const ScanInstant& now);
  /// Those that weigh the believed pose: without what stands about for now, where enough are left.
  const BeamEnds& weighing_ends(const ScanInstant& now);
  /// The best pose that a slip may have led to and that explains at least this share of the ends; nothing without one.
  [[nodiscard]] std::optional<Pose2> explained_nearby(const Pose2& believed, double share) const;
  /// A place that holds nearly all belief, for long enough, and that explains the scan, or does so clearly better.
  [[nodiscard]] bool has_won(const RivalPlace& place, const Pose2& believed) const;
  /// What the localizer answers: where surfaces hold the pose, nothing but another place speaks against it.
  [[nodiscard]] Belief belief() const;
  /// No pose is believed, nor one being checked.
  [[nodiscard]] bool searches() const;
  /// The epoch of the odometry is another one than at the last scan.
  [[nodiscard]] bool has_jumped(const ScanInstant& now) const;
  /// Do the wheels tell what has been driven since the last scan?
  [[nodiscard]] bool covers_the_gap(const ScanInstant& now) const;
  [[nodiscard]] FitMonitor::Observation passed_since_last_scan(const ScanInstant& now) const;
  void judge_start(double fit);
  /// The monitor has changed its mind.
  void enter(LocalizerState after, LocalizerState before, const Pose2& believed, const ScanInstant& now);
  [[nodiscard]] Pose2 joined_at(const ScanInstant& now) const;
};

}  // namespace deltamap::localization
