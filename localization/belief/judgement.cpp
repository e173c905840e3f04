// SPDX-License-Identifier: Apache-2.0
#include "localization/belief/judgement.hpp"

#include <algorithm>

#include "core/geometry/pose_spread.hpp"

namespace deltamap::localization::belief {
namespace {

// Share of all kidnappings after which the scans go on as if there had been none: where the new place looks the same.
constexpr double kKidnappedWithoutABreak = 0.1;

/// The share of the belief that is left to a hypothesis which is so much less likely.
double with_less_odds(double share, double times) { return times * share / (1.0 - share + times * share); }

PoseJudge::Shares shares_in(const hypotheses::HypothesisReport& report, bool may_have_been_kidnapped) {
  if (report.followed == 0) return {.searching = !report.own_known, .beaten = false};
  if (report.own_known) {
    const hypotheses::ReportedHypothesis& other = report.others.front();
    const double kidnapped_share = may_have_been_kidnapped
                                       ? report.kidnapped_share
                                       : with_less_odds(report.kidnapped_share, kKidnappedWithoutABreak);
    const bool kidnapped = kidnapped_share > other.share;
    return {.believed = report.own_share,
            .best_other = std::max(other.share, kidnapped_share),  // one of them may be watched, not listed
            .if_kidnapped = report.kidnapped_share,
            .map_from_other = kidnapped ? report.map_from_kidnapped : other.map_from_robot,
            .beaten = report.beaten};
  }
  const hypotheses::ReportedHypothesis& second = report.others[1];
  return {.believed = report.others.front().share,
          .best_other = report.listed > 1 ? second.share : 0.0,
          .map_from_other = second.map_from_robot,
          .searching = true};
}

}  // namespace

Judgement::Judgement(const OccupancyGrid& map, const JudgementParams& params)
    : params_{params},
      stability_{map.geometry()},
      judge_{params.verdict},
      continuity_{params.scan_break},
      known_ground_{map} {}

void Judgement::start(double pose_right) {
  judge_.start(pose_right);
  continuity_.start();
  since_check_.reset();
  is_checked_ = false;
  fixed_by_surfaces_ = false;
  carried_.end();
}

Belief Judgement::belief() const {
  Belief belief = is_fixed() ? judge_.belief_if_fixed() : judge_.belief();
  belief.is_checked = is_checked_;
  belief.broke_off_at = continuity_.broke_off_at();
  belief.fits_worse = continuity_.fits_worse();
  belief.is_carried = is_carried();
  belief.is_on_new_ground = known_ground_.is_left();
  return belief;
}

double Judgement::trust() const { return is_fixed() ? std::max(judge_.trust(), kAsRightAsWrong) : judge_.trust(); }

bool Judgement::due(const PoseJudge::Passed& passed) {
  if (!since_check_) return true;
  since_check_->driven_m += passed.driven_m;
  since_check_->turned_rad += passed.turned_rad;
  since_check_->time_s += passed.time_s;
  return since_check_->driven_m >= params_.check_m || since_check_->turned_rad >= params_.check_rad ||
         since_check_->time_s >= params_.check_s;
}

void Judgement::follow(const FollowedScan& scan, bool is_tracking) {
  if (continuity_.observe(scan, judge_.belief(), is_tracking)) judge_.start(kAsRightAsWrong);
}

void Judgement::observe(const View& view) {
  is_checked_ = false;
  if (!due(view.passed)) return;
  const PoseJudge::Passed passed = since_check_.value_or(PoseJudge::Passed{});
  since_check_ = PoseJudge::Passed{};
  const std::span<const CheckedBeam> beams = check_.check(view.map, view.scan, view.rays, view.believed);
  judge_.observe(tallied(beams, stability_), passed, shares_in(view.hypotheses, continuity_.may_have_been_kidnapped()));
  is_checked_ = true;
  known_ground_.observe(beams, view.map.geometry(), passed.driven_m);
  const bool is_sure = view.state == LocalizerState::kTracking && judge_.trust() >= kSurelyRight;
  if (is_sure && view.fits) carried_.start_from_here();
  earn(beams, view);
}

void Judgement::earn(std::span<const CheckedBeam> beams, const View& view) {
  const bool sure = view.state == LocalizerState::kTracking && judge_.trust() >= kSurelyRight &&
                    widest_deviation_m(view.believed.covariance) <= params_.earn_deviation_m;
  if (!sure) return;
  const Point2 seen_from = view.believed.map_from_robot.position();
  for (const CheckedBeam& beam : beams) {
    if (beam.what == BeamFit::kFit) stability_.confirm(beam.expected, seen_from, view.scan.time);
    if (beam.what == BeamFit::kBeyond) stability_.refute(beam.expected, seen_from, view.scan.time);
  }
}

void Judgement::forget(const OccupancyGrid& before, const OccupancyGrid& next) {
  if (before.geometry() == next.geometry()) {
    stability_.forget(changes_between(before, next));
  } else {
    stability_ = Stability{next.geometry()};
  }
}

}  // namespace deltamap::localization::belief
