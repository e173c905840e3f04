// SPDX-License-Identifier: Apache-2.0
// The state machine of the localizer: global, tracking or lost. A changed map makes scans fit worse for long, so a bad
// fit alone does not make the robot lost. It is lost where the verdict stays "wrong", or where for very long the pose
// has not fitted and nothing has supported it. A lost robot searches the whole map anew where another hypothesis has
// beaten the pose, else once it has driven on.
#pragma once

#include "core/geometry/angle.hpp"
#include "core/messages.hpp"
#include "localization/particles/particle_clusters.hpp"

namespace deltamap::localization::belief {

/// A fit is the share of a scan's ends that the map explains at the estimated pose (explained_share), in [0, 1]. On the
/// real logs it stays above 0.8 at the right pose, falls to 0.35 for seconds where much has changed, and wavers around
/// 0.3 at a wrong pose.
struct FitParams {
  double memory_s = 3.0;                 ///< time constant of the fit's running mean, s; > 0
  double lost_below = 0.4;               ///< mean fit that counts as misfit; 0..1
  double found_above = 0.6;              ///< mean fit that counts as found again; lost_below..1
  double lost_after_s = 90.0;            ///< unbroken misfit until lost, s; > 0: for so long a stale map may not fit
  double suspicious_below = 0.85;        ///< mean fit that is a reason to look elsewhere too; 0..1
  double lost_by_verdict_s = 1.5;        ///< unbroken verdict "wrong" until lost, s; >= 0
  double search_after_s = 10.0;          ///< lost until the whole map is searched, s; >= 0
  double search_after_m = 2.0;           ///< driven while lost until then, m; >= 0: someone may stand in the way
  double converged_m = 0.3;              ///< deviation of position that ends global localization, m; > 0
  double converged_rad = radians(10.0);  ///< deviation of heading that ends global localization, rad; > 0
  double converged_after_m = 2.0;        ///< driven before it may end, m; >= 0: one view may look like another
  double converged_after_rad = radians(172.0);  ///< or heading turned before it may, rad; >= 0
  double converged_unfit_after_m = 8.0;  ///< driven before it may end where little fits: the map may be old, m; >= 0
};

class FitMonitor {
 public:
  explicit FitMonitor(const FitParams& params) : params_{params} {}

  void start(LocalizerState state);

  struct Observation {
    double passed_s = 0.0;  ///< since the last scan
    double driven_m = 0.0;  ///< since the last scan
    double turned_rad = 0.0;
    double fit = 0.0;
    PoseVerdict verdict = PoseVerdict::kUndecided;
    double trust = 0.5;    ///< P(pose right) by all beams, whether on proven tiles or not
    bool beaten = false;   ///< another hypothesis explains the recent scans clearly better
    bool is_held = false;  ///< by surfaces, however badly the scan fits (Judgement)
  };
  /// The state after this scan. kGlobal after kLost: the whole map is to be searched.
  LocalizerState observe(const Observation& scan, const particles::ParticleCluster& best);

  [[nodiscard]] LocalizerState state() const { return state_; }
  /// Nothing speaks for the pose at present: time to look elsewhere, not yet to give it up.
  [[nodiscard]] bool suspicious() const;

 private:
  [[nodiscard]] bool converged(const particles::ParticleCluster& best) const;
  void enter(LocalizerState state);
  void count(const Observation& scan);

  FitParams params_;
  LocalizerState state_ = LocalizerState::kGlobal;
  double in_state_s_ = 0.0;
  double driven_in_state_m_ = 0.0;
  double turned_in_state_rad_ = 0.0;
  double misfit_s_ = 0.0;      ///< unbroken
  double wrong_s_ = 0.0;       ///< unbroken
  double distrusted_s_ = 0.0;  ///< unbroken
  bool beaten_ = false;        ///< lost to another hypothesis
  double mean_fit_ = 0.5;      ///< running mean
  bool any_fit_ = false;
};

}  // namespace deltamap::localization::belief
