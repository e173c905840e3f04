// SPDX-License-Identifier: Apache-2.0
#include "localization/hypotheses/hypothesis_tracker.hpp"

#include <algorithm>
#include <cmath>

#include "localization/sensor/weighing.hpp"

namespace deltamap::localization::hypotheses {
namespace {

constexpr double kOverlooked = -2.0;     // log odds of a hypothesis that earlier looks did not find
constexpr double kFarthestBehind = 6.0;  // log evidence: the stack may hold scans from before a slip

// At one place, within so much, so many scans are looked at: a few rounds of all hypotheses.
constexpr double kPlaceM = 0.01;
constexpr double kPlaceRad = radians(0.5);
constexpr int kLooksAtAPlace = 25;

}  // namespace

HypothesisTracker::HypothesisTracker(const HypothesisTrackerParams& params, const GlobalSearchParams& search,
                                     const OccupancyGrid& map, const sensor::LikelihoodField& field, std::uint64_t seed)
    : params_{params},
      coarse_{map, field, params.block_m},
      probes_{params.headings, seed},
      alias_monitor_{
          {.probes = params.probes / 2, .refined = params.refined_a_scan, .prior = params.kidnapped_now_prior}},
      search_{search, params.headings},
      elsewhere_prior_{params.elsewhere_prior} {}

void HypothesisTracker::start_believing() {
  believing_ = true;
  elsewhere_prior_ = params_.elsewhere_prior;
  forget_hypotheses();
  report_ = {};
}

/// And all that was seen.
void HypothesisTracker::forget_hypotheses() {
  bank_.clear();
  alias_monitor_.clear();
  stack_.clear();
  decorrelation_.clear();
  outlier_rate_.forget();
  looks_at_place_ = 0;
}

/// What spoke for other hypotheses spoke against a pose that has been mended since.
void HypothesisTracker::forget_kidnapping() {
  bank_.forget_kidnapping();
  alias_monitor_.clear();
}

bool HypothesisTracker::has_jumped(const Pose2& map_from_believed) const {
  return last_believed_ && !is_same(map_from_believed, *last_believed_);
}

void HypothesisTracker::start_believing_in(const Pose2& found) {
  believing_ = true;
  looks_at_place_ = 0;
  forget_kidnapping();
  bank_.set_believed_prior(0.0);
  if (!is_near_believed(found)) {
    elsewhere_prior_ = params_.prior_after_search;
    stack_.clear();  // its scans are from before the robot was carried off
    outlier_rate_.forget();
    bank_.set_priors([](const Pose2&) { return 0.0; });
  }
  bank_.believe_among(found);
  write_report();
}

void HypothesisTracker::stop_believing() {
  believing_ = false;
  looks_at_place_ = 0;
  bank_.stop_believing();
  bank_.set_priors([&](const Pose2& pose) { return log_prior_unbelieved(pose); });
  search_.start();
  if (report_.beaten) stack_.keep_last(report_.beaten_for_m);
  write_report();
}

void HypothesisTracker::suspect(bool suspicious) {
  if (suspicious && !suspicious_ && !search_.under_way()) search_.start();
  suspicious_ = suspicious;
}

void HypothesisTracker::start_anywhere() {
  forget_hypotheses();
  last_believed_.reset();
  stop_believing();
}

bool HypothesisTracker::is_near_believed(const Pose2& pose) const {
  return last_believed_ && is_nearby(pose, *last_believed_);
}

double HypothesisTracker::log_prior_unbelieved(const Pose2& pose) const {
  return !last_believed_ || is_near_believed(pose) ? 0.0 : std::log(params_.kidnapped_prior);
}

std::optional<PoseHypothesis> HypothesisTracker::best_hypothesis() const {
  const PoseHypothesis* const best = bank_.reference();
  if (best == nullptr) return std::nullopt;
  PoseHypothesis found = *best;
  found.share = share_around(bank_, best->map_from_robot);
  return found;
}

void HypothesisTracker::apply(const OccupancyGrid& map, const sensor::LikelihoodField& field, const CellBox& changed) {
  const bool whole = changed.width() == map.width() && changed.height() == map.height();
  if (whole) {
    coarse_ = sensor::CoarseField{map, field, params_.block_m};  // it may have grown
  } else {
    coarse_.update(map, field, changed);
  }
  looks_at_place_ = 0;
}

void HypothesisTracker::thin(const motion::BeamEnds& ends) {
  const std::size_t count = std::min(HypothesisBank::kBeams, ends.size());
  ends_.range_deviation_m = ends.range_deviation_m;
  ends_.x_m.resize(count);
  ends_.y_m.resize(count);
  for (std::size_t i = 0; i < count; ++i) {
    const std::size_t from = i * ends.size() / count;
    ends_.x_m[i] = ends.x_m[from];
    ends_.y_m[i] = ends.y_m[from];
  }
  keep_near_ends();
}

/// All where only few are near.
void HypothesisTracker::keep_near_ends() {
  constexpr double kNear_m = 10.0;  // half a step of the lattice's headings turns an end by a block there
  constexpr std::size_t kEnough = 12;
  motion::keep_ends(
      ends_, [](const Point2& end) { return end.norm() <= kNear_m; }, near_ends_);
  if (near_ends_.size() < kEnough) near_ends_ = ends_;
}

std::vector<sensor::ProposedPose> HypothesisTracker::poses_within(const sensor::RefinedPose& prior,
                                                                  const sensor::LikelihoodField& field,
                                                                  const motion::BeamEnds& ends) {
  thin(ends);
  return hypotheses::poses_within(prior, coarse_, field, {ends_, near_ends_}, params_.headings);
}

const HypothesisReport& HypothesisTracker::observe(const sensor::LikelihoodField& field, const Seen& seen) {
  const Pose2 motion = last_odom_ ? motion_between(*last_odom_, seen.continuous_odom_from_robot) : Pose2{};
  last_odom_ = seen.continuous_odom_from_robot;
  bank_.predict(motion);
  alias_monitor_.predict(motion);
  if (last_believed_) last_believed_ = *last_believed_ * motion;
  if (believing_ && seen.map_from_believed) {
    if (has_jumped(*seen.map_from_believed)) forget_kidnapping();
    bank_.believe(*seen.map_from_believed);
  }
  if (believing_) last_believed_ = seen.map_from_believed;
  support_nats_ = believing_ ? params_.stable_support_nats * seen.stable_support : 0.0;
  bank_.set_believed_prior(support_nats_);
  if (seen.kidnapped && !kidnapped_) search_.start();  // not with a scan from before
  kidnapped_ = seen.kidnapped;
  bank_.make_room(suspicious_ || kidnapped_);
  since_step_.add(motion);
  since_place_.add(motion);
  if (seen.ends.size() > 0 && tells_more()) look(field, seen);
  return report_;
}

bool HypothesisTracker::tells_more() {
  if (since_place_.reaches(kPlaceM, kPlaceRad) || (searches() && search_.under_way())) {
    since_place_ = {};
    looks_at_place_ = 0;
  }
  return ++looks_at_place_ <= kLooksAtAPlace;
}

void HypothesisTracker::Way::add(const Pose2& motion) {
  driven_m += motion.position().norm();
  turned_rad += std::abs(motion.theta);
}

void HypothesisTracker::look(const sensor::LikelihoodField& field, const Seen& seen) {
  thin(seen.ends);
  const auto how_many = believing_ ? static_cast<std::size_t>(params_.refined_a_scan) : HypothesisBank::kMost;
  bank_.refine(field, ends_, how_many, seen.unknown_s);
  weigh(field, seen);
  if (believing_) probe(field, seen.continuous_odom_from_robot);
  if (searches()) {
    const std::span<const Pose2> found =
        search_.look(coarse_, field, {ends_, near_ends_}, seen.continuous_odom_from_robot, believing_ && !kidnapped_);
    if (!found.empty()) admit_all(field, found, seen.continuous_odom_from_robot);
  }
  bank_.settle();
  stack_.add(ends_, seen.continuous_odom_from_robot);
  write_report();
}

HypothesisTracker::Odds HypothesisTracker::odds_beside_believed(const ScanStack::Sums& its,
                                                                const ScanStack::Sums& others) const {
  double lately = 0.0;
  double in_all = 0.0;
  for (std::size_t k = 0; k < stack_.size(); ++k) {
    in_all = HypothesisBank::kEvidenceOfABeam * (its[k] - others[k]);
    lately = std::max(lately, in_all);
  }
  const Odds kidnapped{std::min(lately, params_.most_ahead), std::log(params_.elsewhere_prior)};
  const Odds overlooked{std::min(in_all, params_.most_ahead), std::log(elsewhere_prior_)};
  return kidnapped.ahead + kidnapped.log_prior > overlooked.ahead + overlooked.log_prior ? kidnapped : overlooked;
}

HypothesisTracker::Odds HypothesisTracker::odds_unbelieved(const Pose2& pose, const ScanStack::Sums& its,
                                                           const ScanStack::Sums& others) const {
  const std::size_t scans = stack_.size();
  const double ahead = scans == 0 ? 0.0 : HypothesisBank::kEvidenceOfABeam * (its[scans - 1] - others[scans - 1]);
  return {ahead, log_prior_unbelieved(pose)};
}

Comparison HypothesisTracker::brought_by(const sensor::LikelihoodField& field, const Pose2& pose,
                                         const Pose2& odom) const {
  if (!believing_ || bank_.hypotheses().empty()) return {};
  const double of_a_beam = outlier_rate_.evidence_weight() * HypothesisBank::kEvidenceOfABeam;
  return stack_.compared_lately(field, pose, bank_.hypotheses().front().map_from_robot, odom, of_a_beam);
}

void HypothesisTracker::admit_all(const sensor::LikelihoodField& field, std::span<const Pose2> poses,
                                  const Pose2& odom) {
  constexpr double kJustFoundM = 0.5;
  const PoseHypothesis* const best = bank_.reference();
  const bool proven = best != nullptr && best->followed_m > kJustFoundM;  // then no newcomer starts ahead of it
  const Pose2 held_against = best != nullptr ? best->map_from_robot : poses.front();
  const ScanStack::Sums others = stack_.log_likelihoods(field, held_against, odom);
  const double base = best != nullptr ? best->log_evidence : 0.0;
  for (const Pose2& pose : poses) {
    if (bank_.knows(pose)) continue;
    const ScanStack::Sums its = stack_.log_likelihoods(field, pose, odom);
    Odds odds = believing_ ? odds_beside_believed(its, others) : odds_unbelieved(pose, its, others);
    if (proven) odds.log_prior += kOverlooked;
    if (proven && !believing_) odds.ahead = std::min(0.0, odds.ahead);
    const Comparison brought = odds.ahead > 0.0 ? brought_by(field, pose, odom) : Comparison{};
    bank_.admit({.map_from_robot = pose,
                 .log_evidence = base + odds.ahead,
                 .log_prior = odds.log_prior,
                 .since_kidnapping = brought.ahead(),
                 .lost_since = brought.lost});
  }
}

/// The scan speaks for or against all hypotheses where it tells something new.
void HypothesisTracker::weigh(const sensor::LikelihoodField& field, const Seen& seen) {
  const bool believes = believing_ && !bank_.hypotheses().empty();
  std::span<const float> weights;
  if (since_step_.reaches(HypothesisBank::kStepM, HypothesisBank::kStepRad)) {
    weights = decorrelation_.weights(ends_, seen.continuous_odom_from_robot);
    if (believes)
      outlier_rate_.observe(1.0 - sensor::explained_share(field, ends_, bank_.hypotheses().front().map_from_robot));
    bank_.weigh(field, ends_, weights, outlier_rate_.evidence_weight());
    since_step_ = {};
  }
  if (!believes) return alias_monitor_.clear();
  alias_monitor_.observe({.field = field,
                          .coarse = coarse_,
                          .ends = ends_,
                          .near_ends = near_ends_,
                          .map_from_believed = bank_.hypotheses().front().map_from_robot,
                          .continuous_odom_from_robot = seen.continuous_odom_from_robot,
                          .stack = stack_,
                          .evidence_weight = outlier_rate_.evidence_weight(),
                          .weights = weights,
                          .unknown_s = seen.unknown_s});
}

void HypothesisTracker::probe(const sensor::LikelihoodField& field, const Pose2& odom) {
  if (bank_.hypotheses().empty()) return;
  probes_.look(coarse_, near_ends_, static_cast<std::size_t>(params_.probes));
  probe_nearby_next_ = !probe_nearby_next_;
  const Pose2 believed = bank_.hypotheses().front().map_from_robot;
  const double own_fit = mean_log_likelihood(field, ends_, believed);
  const std::optional<Pose2> found =
      probe_nearby_next_
          ? probes_.best_nearby(field, ends_, bank_, {believed, kNearbyM, kNearbyRad}, params_.probes_nearby)
          : probes_.best_anywhere(own_fit - kFitsNearlyAsWell);
  if (found) admit_beside_believed(field, *found, odom, own_fit);
}

/// Beside a believed pose only what fits the scan nearly as well is worth following.
void HypothesisTracker::admit_beside_believed(const sensor::LikelihoodField& field, const Pose2& rough,
                                              const Pose2& odom, double own_fit) {
  const PoseHypothesis& own = bank_.hypotheses().front();
  const Pose2 pose = settled(field, ends_, rough);
  if (bank_.knows(pose)) return;
  const double gain = mean_log_likelihood(field, ends_, pose) - own_fit;
  if (gain < -kFitsNearlyAsWell) return;
  const bool nearby = is_nearby(pose, own.map_from_robot);
  if (nearby) {  // a slip lies behind it: before that, the scans say nothing of it
    const double beams = HypothesisBank::kEvidenceOfABeam * static_cast<double>(ends_.size());
    const double ahead = std::clamp(beams * gain, -kFarthestBehind, 0.0);
    return bank_.admit({.map_from_robot = pose,
                        .log_evidence = own.log_evidence + ahead,
                        .log_prior = std::log(params_.nearby_prior)});
  }
  const ScanStack::Sums its = stack_.log_likelihoods(field, pose, odom);
  const ScanStack::Sums owns = stack_.log_likelihoods(field, own.map_from_robot, odom);
  const Comparison brought = brought_by(field, pose, odom);
  const Odds odds = odds_beside_believed(its, owns);
  bank_.admit({.map_from_robot = pose,
               .log_evidence = own.log_evidence + odds.ahead,
               .log_prior = odds.log_prior,
               .since_kidnapping = brought.ahead(),
               .lost_since = brought.lost});
}

void HypothesisTracker::write_report() {
  report_ =
      report_on(bank_, alias_monitor_.hypotheses(),
                {.kidnapped_now_prior = params_.kidnapped_now_prior, .beats_by = params_.beats_by + support_nats_});
}

}  // namespace deltamap::localization::hypotheses
