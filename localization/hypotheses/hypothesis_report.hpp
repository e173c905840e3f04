// SPDX-License-Identifier: Apache-2.0
// Sums up the hypothesis bank after a scan: the best hypotheses beside the believed one, their shares of the belief,
// how probable it is that the robot was kidnapped, and whether a hypothesis has beaten the believed one.
#pragma once

#include <array>
#include <cstddef>

#include "core/geometry/angle.hpp"
#include "core/geometry/pose2.hpp"
#include "localization/hypotheses/hypothesis_bank.hpp"

namespace deltamap::localization::hypotheses {

// A hypothesis so near the believed one is a slip.
inline constexpr double kNearbyM = 1.5;
inline constexpr double kNearbyRad = radians(20.0);
[[nodiscard]] inline bool is_nearby(const Pose2& pose, const Pose2& believed) {
  return is_within(pose, believed, kNearbyM, kNearbyRad);
}

// When a hypothesis is believed.
inline constexpr double kWinningShare = 0.98;  ///< of the belief, at least
inline constexpr double kWinsAfterM = 1.0;     ///< driven since it was found beside a believed pose, at least

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
  double kidnapped_now_prior;  ///< odds that the robot has just been carried to a pose that fits from then on; 0..1
  double beats_by;             ///< log evidence of clearly better, proven tiles counted in; > 0
};

/// `watched`: aliases of the believed pose, of which only is told whether the robot may have been carried to one.
[[nodiscard]] HypothesisReport report_on(const HypothesisBank& bank, const HypothesisBank& watched,
                                         const ReportRules& rules);

/// Share of the belief of all hypotheses about the pose, the believed one left out.
[[nodiscard]] double share_around(const HypothesisBank& bank, const Pose2& pose);

}  // namespace deltamap::localization::hypotheses
