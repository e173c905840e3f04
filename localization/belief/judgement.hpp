// SPDX-License-Identifier: Apache-2.0
// Answers two questions at each scan: is the pose right, and is the map wrong here? Checks the beams at the estimated
// pose, lets the tiles of the map earn their stability while the pose is well known, and keeps the belief.
#pragma once

#include <optional>
#include <span>

#include "localization/belief/beam_check.hpp"
#include "localization/belief/carried_pose.hpp"
#include "localization/belief/continuity.hpp"
#include "localization/belief/known_ground.hpp"
#include "localization/belief/pose_verdict.hpp"
#include "localization/belief/stability.hpp"
#include "localization/belief/view_tally.hpp"
#include "localization/hypotheses/hypothesis_report.hpp"

namespace deltamap::localization::belief {

struct JudgementParams {
  PoseVerdictParams verdict;
  ScanBreakParams scan_break;
  double check_m = 0.1;             ///< beams are checked again after so much driving, m; >= 0
  double check_rad = radians(2.0);  ///< or turning, rad; >= 0
  double check_s = 0.4;             ///< or waiting, s; >= 0
  double earn_deviation_m = 0.1;  ///< the σ below which a pose that is surely right lets tiles earn stability, m; > 0
};

class Judgement {
 public:
  Judgement(const OccupancyGrid& map, const JudgementParams& params);

  /// Begins anew at a pose that is right with this probability.
  void start(double pose_right);

  /// A person has given the pose, or the whole map is searched for it.
  void start_on_known_ground() { known_ground_.start(); }

  /// Every scan, first of all: has the robot come here from the last one as its wheels tell?
  void carry(const CarriedPose::Step& step) { carried_.observe(step); }

  /// Every scan, before it is observed: was the robot carried? Then the pose is as right as wrong.
  void follow(const FollowedScan& scan, bool is_tracking);

  struct View {
    const OccupancyGrid& map;
    const Scan& scan;
    std::span<const RayInRobot> rays;
    const sensor::RefinedPose& believed;
    LocalizerState state = LocalizerState::kGlobal;
    PoseJudge::Passed passed;  ///< since the last scan
    const hypotheses::HypothesisReport& hypotheses;
    bool fits = false;  ///< the map explains most of what is seen
  };
  /// Not every scan is held against the map: between two that are, the belief stays as it is (Belief::is_checked),
  /// unless follow() tells of a kidnapping.
  void observe(const View& view);
  /// Do surfaces of the map fix the pose at this scan? Where it has been followed without a break, nothing but another
  /// pose speaks against it then, however many beams end elsewhere; it is surely right only where proven tiles have
  /// told of it lately (PoseJudge::limit). Holds until the next call or start().
  void fix_by_surfaces(bool fixed) { fixed_by_surfaces_ = fixed; }

  /// Wheels and scans have carried it here from where it was surely right, and it has been followed without a break.
  [[nodiscard]] bool is_carried() const { return carried_.is_carried() && continuity_.is_unbroken(); }
  /// Surfaces fix the pose, or it is carried, and it has been followed without a break.
  [[nodiscard]] bool is_fixed() const {
    return (fixed_by_surfaces_ || carried_.is_carried()) && continuity_.is_unbroken();
  }
  /// It is fixed, and no other hypothesis speaks against it: to be surely right it lacks proven tiles at
  /// most.
  [[nodiscard]] bool is_held() const { return is_fixed() && judge_.is_surely_right(1.0 - judge_.belief().other_share); }

  [[nodiscard]] Belief belief() const;
  /// P(pose right) by all beams, whether on proven tiles or not; at least one half where surfaces fix the pose. Tiles
  /// earn stability by the beams alone.
  [[nodiscard]] double trust() const;

  /// The map is replaced by `next`: what differs has to earn its stability again.
  void forget(const OccupancyGrid& before, const OccupancyGrid& next);
  void forget(std::span<const CellChange> changes) { stability_.forget(changes); }

  [[nodiscard]] const Stability& stability() const { return stability_; }
  [[nodiscard]] bool restore(const StabilityRecord& record) { return stability_.restore(record); }

 private:
  [[nodiscard]] bool due(const PoseJudge::Passed& passed);
  void check(const View& view);
  void earn(std::span<const CheckedBeam> beams, const View& view);

  JudgementParams params_;
  Stability stability_;
  BeamCheck check_;
  PoseJudge judge_;
  Continuity continuity_;
  std::optional<PoseJudge::Passed> since_check_;  ///< none: nothing checked yet
  bool is_checked_ = false;                       ///< Belief::is_checked
  bool fixed_by_surfaces_ = false;
  CarriedPose carried_;
  KnownGround known_ground_;
};

}  // namespace deltamap::localization::belief
