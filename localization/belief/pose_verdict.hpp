// SPDX-License-Identifier: Apache-2.0
// P(pose right) and P(map wrong), accumulated over the views of a drive. Beams on proven tiles, and with less weight
// all others, are evidence about the pose: it must be supported in both directions, for along a wall every pose fits.
// All beams together are evidence about the map, given that the pose is right. Other pose hypotheses that explain the
// scans as well take belief away. A view counts by how new it is: standing still, or people who walk by, add no
// certainty.
#pragma once

#include <algorithm>
#include <optional>

#include "core/geometry/angle.hpp"
#include "core/messages.hpp"
#include "localization/belief/view_tally.hpp"

namespace deltamap::localization::belief {

/// P(pose right) up to which a pose counts as surely wrong, and from which as surely right.
inline constexpr double kSurelyWrong = 0.1;
inline constexpr double kSurelyRight = 1.0 - kSurelyWrong;
/// Of a pose that nothing speaks for or against.
inline constexpr double kAsRightAsWrong = 0.5;

struct PoseVerdictParams {
  double view_m = 0.5;              ///< a view is new after so much driving, m; > 0
  double view_rad = radians(20.0);  ///< or turning, rad; > 0
  double view_s = 5.0;              ///< or waiting, s; > 0
  double least_beams = 3.0;         ///< that must tell of a direction before it counts; > 0
  double unproven_weight = 0.5;     ///< of a beam on a tile that has not proven to stay, against one that has; 0..1
  double lost_in_a_view = 0.002;    ///< P(the pose has become wrong since the last new view); 0..0.1
  double least_wrong = 0.0005;      ///< P(wrong) that no evidence ever undercuts; 0..0.1
  double unproven_limit = 0.85;     ///< without proven tiles the beams leave P(right) within this and 1 - this; 0.5..1
  double proof_memory_views = 4.0;  ///< for so many views it still counts that proven tiles supported the pose; > 0
  double changed_above = 0.1;       ///< share of beams off the map from which it is rather wrong than right; 0..1
};

class PoseJudge {
 public:
  explicit PoseJudge(const PoseVerdictParams& params) : params_{params} {}

  /// Begins anew at a pose that is right with this probability.
  void start(double pose_right);

  struct Passed {
    double driven_m = 0.0;
    double turned_rad = 0.0;  ///< either way
    double time_s = 0.0;
  };
  /// How the belief is shared between the pose hypotheses.
  struct Shares {
    double believed = 1.0;
    double best_other = 0.0;
    double if_kidnapped = 0.0;  ///< of an alias, were kidnappings after which no scan breaks off as likely as others
    Pose2 map_from_other{};
    bool searching = false;  ///< no hypothesis is believed yet: `believed` is the best one's
    bool beaten = true;      ///< another hypothesis explains the recent scans clearly better
  };
  void observe(const ViewTally& view, const Passed& passed, const Shares& shares);

  /// By the beams, as they were last held against the map.
  [[nodiscard]] const Belief& belief() const { return belief_; }
  /// Where surfaces fix the pose: nothing but another pose speaks against it, however many beams end elsewhere.
  [[nodiscard]] Belief belief_if_fixed() const { return judged(limit()); }
  /// P(pose right) by all that is in view, proven or not: what stability is earned by.
  [[nodiscard]] double trust() const { return trust_; }
  /// As much as P(pose right) may be: less than surely right where no proven tiles have told of the pose lately.
  [[nodiscard]] double limit() const;
  /// May a pose be called right that is right with this probability? Not where the robot may have been carried to an
  /// alias by someone who chose it.
  [[nodiscard]] bool is_surely_right(double pose_right) const {
    return std::min(pose_right, 1.0 - shares_.if_kidnapped) >= kSurelyRight;
  }

 private:
  [[nodiscard]] double novelty(const Passed& passed, std::optional<double> support);
  void judge_map(const ViewTally& view, double novelty);
  [[nodiscard]] Belief judged(double right_by_beams) const;

  PoseVerdictParams params_;
  double right_log_odds_ = 0.0;
  double trust_ = 0.5;
  double proof_ = 0.0;         ///< 1 where proven tiles are in view; fades
  double misfit_share_ = 0.0;  ///< running mean over the last views
  bool any_view_ = false;
  std::optional<double> last_support_;
  Shares shares_;  ///< at the last view
  Belief belief_;
};

}  // namespace deltamap::localization::belief
