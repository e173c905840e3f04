// SPDX-License-Identifier: Apache-2.0
// Sums up the hypothesis bank after a scan: the best hypotheses beside the believed one, their shares of the belief,
// how probable it is that the robot was kidnapped, and whether a hypothesis has beaten the believed one.
#pragma once

#include <array>
#include <cstddef>

#include "core/geometry/pose2.hpp"
#include "localization/hypotheses/hypothesis_bank.hpp"

namespace deltamap::localization::hypotheses {

/// A hypothesis that is not believed, with what speaks for it.
struct ReportedHypothesis {
  Pose2 map_from_robot;
  double share = 0.0;         ///< of the belief, [0, 1]
  double share_around = 0.0;  ///< the same of all hypotheses within some decimetres of it together
  double followed_m = 0.0;    ///< driven since it was found
};

/// The believed hypothesis and the best others. All shares, those of hypotheses not listed too, sum to 1.
struct HypothesisReport {
  static constexpr std::size_t kListed = 4;
  bool own_known = false;  ///< false: nothing is believed, the best hypothesis leads `others`
  double own_share = 0.0;
  std::array<ReportedHypothesis, kListed> others;  ///< best first
  std::size_t listed = 0;                          ///< of them in use
  std::size_t followed = 0;                        ///< followed in all, the believed one too
  double effective_hypotheses = 1.0;               ///< 1 / Σ share²
  double kidnapped_share = 0.0;  ///< of belief in the best hypothesis, had the robot been carried there lately; [0, 1)
  Pose2 map_from_kidnapped;      ///< that hypothesis; of no meaning where its share is 0
  bool beaten = false;           ///< one of them explains the recent scans clearly better than the believed pose
  double beaten_for_m = 0.0;     ///< so long the hypotheses that do have been followed; 0: none does
};

/// The limits that the report is drawn by.
struct ReportRules {
  double nearby_m;             ///< a hypothesis within this of the believed one is a slip; > 0
  double nearby_rad;           ///< and turned less; > 0
  double kidnapped_now_prior;  ///< odds that the robot has just been carried to a pose that fits from then on; 0..1
  double beats_by;             ///< log evidence of clearly better, proven tiles counted in; > 0
  double wins_after_m;         ///< driven since such a hypothesis was found, m; >= 0
};

/// `watched`: aliases of the believed pose, of which only is told whether the robot may have been carried to one.
[[nodiscard]] HypothesisReport report_on(const HypothesisBank& bank, const HypothesisBank& watched,
                                         const ReportRules& rules);

/// Share of the belief of all hypotheses about the pose, the believed one left out.
[[nodiscard]] double share_around(const HypothesisBank& bank, const Pose2& pose, double turn_rad);

}  // namespace deltamap::localization::hypotheses
