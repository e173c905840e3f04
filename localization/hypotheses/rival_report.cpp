// SPDX-License-Identifier: Apache-2.0
#include "localization/hypotheses/rival_report.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace deltamap::localization::hypotheses {
namespace {

constexpr double kAroundM = 0.6;    // places that the next scans may join
constexpr double kLostAgain = 2.0;  // what was lost counts so often more

/// For a place where the robot may have been carried. There nearly all beams end as expected; where many do not that
/// fit the believed pose it is chance that has found it.
double says(const Place& place) { return std::max(0.0, place.since_carried - kLostAgain * place.lost_since); }

/// Among the best others, where it belongs there.
void list(const Place& place, RivalReport& report) {
  RivalPlace entry{place.map_from_robot, place.log_evidence, place.share, 0.0, place.followed_m};
  for (std::size_t rank = 0; rank < report.listed; ++rank) {
    if (entry.share > report.rivals[rank].share) std::swap(entry, report.rivals[rank]);
  }
  if (report.listed < RivalReport::kListed) report.rivals[report.listed++] = entry;
}

}  // namespace

double share_around(const PlaceBank& bank, const Pose2& pose, double turn_rad) {
  double share = 0.0;
  for (const Place& place : bank.rivals()) {
    if (is_within(place.map_from_robot, pose, kAroundM, turn_rad)) share += place.share;
  }
  return share;
}

RivalReport report_on(const PlaceBank& bank, const PlaceBank& watched, const RivalRules& rules) {
  RivalReport report;
  report.own_known = report.unique = bank.believing();
  report.places = bank.places().size();
  double squared_shares = 0.0;
  for (const Place& place : bank.places()) squared_shares += place.share * place.share;
  report.effective_places = squared_shares > 0.0 ? 1.0 / squared_shares : 1.0;
  for (const Place& place : bank.rivals()) list(place, report);
  for (std::size_t i = 0; i < report.listed; ++i) {
    report.rivals[i].share_around = share_around(bank, report.rivals[i].map_from_robot, rules.nearby_rad);
  }
  if (!report.own_known || report.places == 0) return report;

  const Place& own = bank.places().front();
  report.own_log_evidence = own.log_evidence;
  report.own_share = own.share;
  for (const Place& place : bank.rivals()) {
    const double ahead = place.log_evidence - own.log_evidence;
    report.unique &= ahead <= -rules.equal_within;
    if (ahead <= rules.beats_by || place.followed_m < rules.wins_after_m) continue;
    report.beaten = true;
    report.beaten_for_m = std::max(report.beaten_for_m, place.followed_m);
  }
  const Place* carried = nullptr;
  for (const PlaceBank* places : {&bank, &watched}) {
    for (const Place& place : places->rivals()) {
      if (is_within(place.map_from_robot, own.map_from_robot, rules.nearby_m, rules.nearby_rad)) continue;
      if (carried == nullptr || says(place) > says(*carried)) carried = &place;
    }
  }
  if (carried == nullptr || says(*carried) <= 0.0) return report;
  report.carried_share = rules.carried_prior / (rules.carried_prior + std::exp(-says(*carried)));
  report.map_from_carried = carried->map_from_robot;
  return report;
}

}  // namespace deltamap::localization::hypotheses
