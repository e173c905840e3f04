// SPDX-License-Identifier: Apache-2.0
// What the places beside the believed one come to: the best of them, what they leave of the belief, and whether one
// has beaten it.
#pragma once

#include <array>
#include <cstddef>

#include "core/pose2.hpp"
#include "localization/hypotheses/place_bank.hpp"

namespace deltamap::localization::hypotheses {

/// A place that is not believed, with what speaks for it.
struct RivalPlace {
  Pose2 map_from_robot;
  double log_evidence = 0.0;  ///< ln p(recent scans | there), from independent beams; <= 0
  double share = 0.0;         ///< of the belief, [0, 1]
  double share_around = 0.0;  ///< the same of all places within some decimetres of it together
  double followed_m = 0.0;    ///< driven since it was found
};

/// The believed place and the best others. All shares, those of places not listed too, sum to 1.
struct RivalReport {
  static constexpr std::size_t kListed = 4;
  bool own_known = false;         ///< false: nothing is believed, the best place leads `rivals`
  double own_log_evidence = 0.0;  ///< as in RivalPlace
  double own_share = 0.0;
  std::array<RivalPlace, kListed> rivals;  ///< best first
  std::size_t listed = 0;                  ///< of them in use
  std::size_t places = 0;                  ///< followed in all, the believed one too
  double effective_places = 1.0;           ///< 1 / Σ share²
  double carried_share = 0.0;  ///< of belief in the best place, had the robot been carried there lately; [0, 1)
  Pose2 map_from_carried;      ///< that place; of no meaning where its share is 0
  bool beaten = false;         ///< one of them explains the recent scans clearly better than the believed place
  double beaten_for_m = 0.0;   ///< so long the places that do have been followed; 0: none does
  bool unique = false;         ///< no place that is followed explains these about as well
};

/// What counts as what.
struct RivalRules {
  double nearby_m = 1.5;         ///< a place within this of the believed one is a slip; > 0
  double nearby_rad = 0.35;      ///< and turned less; > 0
  double carried_prior = 0.003;  ///< odds that the robot has just been carried to a place that fits from then on; 0..1
  double beats_by = 12.0;        ///< log evidence of clearly better, proven tiles counted in; > 0
  double wins_after_m = 1.0;     ///< driven since such a place was found, m; >= 0
  double equal_within = 4.0;     ///< log evidence of about as well; > 0
};

/// `watched`: images of the believed place, of which only is told whether the robot may have been carried to one.
[[nodiscard]] RivalReport report_on(const PlaceBank& bank, const PlaceBank& watched, const RivalRules& rules);

/// Share of the belief of all places about the pose, the believed one left out.
[[nodiscard]] double share_around(const PlaceBank& bank, const Pose2& pose, double turn_rad);

}  // namespace deltamap::localization::hypotheses
