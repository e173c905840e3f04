// SPDX-License-Identifier: Apache-2.0
#include "localization/hypotheses/hypothesis_bank.hpp"

#include <algorithm>
#include <cmath>

#include "core/geometry/points_in_map.hpp"
#include "localization/sensor/weighing.hpp"

namespace deltamap::localization::hypotheses {
namespace {

constexpr std::size_t kMostWhileBelieving = 24;
constexpr double kKept = 1.0 - 1.0 / 40.0;  // of the evidence from one decorrelated scan to the next
constexpr double kHopeless = 14.0;          // behind the best one by so much log evidence a hypothesis is given up

double odds_of(const PoseHypothesis& hypothesis) { return hypothesis.log_evidence + hypothesis.log_prior; }

std::uint8_t steps_at_end(const sensor::LikelihoodField& field, const PointsInMap& in_map, const motion::BeamEnds& ends,
                          std::size_t i) {
  return field.steps_at(field.geometry().cell_at(in_map(Eigen::Vector2f{ends.x_m[i], ends.y_m[i]})));
}

}  // namespace

double mean_log_likelihood(const sensor::LikelihoodField& field, const motion::BeamEnds& ends, const Pose2& pose) {
  if (ends.size() == 0) return 0.0;
  return -sensor::LikelihoodField::kStep * sensor::misfit_steps(field, ends, pose) / static_cast<double>(ends.size());
}

double weighted_log_likelihood(const sensor::LikelihoodField& field, const motion::BeamEnds& ends,
                               std::span<const float> weights, const Pose2& pose) {
  const PointsInMap in_map{pose};
  double sum = 0.0;
  for (std::size_t i = 0; i < ends.size(); ++i) {
    sum += static_cast<double>(weights[i]) * steps_at_end(field, in_map, ends, i);
  }
  return -sensor::LikelihoodField::kStep * sum;
}

Comparison compared(const sensor::LikelihoodField& field, const motion::BeamEnds& ends, std::span<const float> weights,
                    const Pose2& hypothesis, const Pose2& other, double of_a_beam) {
  const PointsInMap from_hypothesis{hypothesis};
  const PointsInMap from_other{other};
  Comparison result;
  for (std::size_t i = 0; i < ends.size(); ++i) {
    const int more = steps_at_end(field, from_other, ends, i) - steps_at_end(field, from_hypothesis, ends, i);
    (more > 0 ? result.gained : result.lost) += static_cast<double>(weights[i]) * std::abs(more);
  }
  const double of_a_step = of_a_beam * sensor::LikelihoodField::kStep;
  return {of_a_step * result.gained, of_a_step * result.lost};
}

bool is_same(const Pose2& a, const Pose2& b) {
  constexpr double kSameM = 0.3;
  const double x_m = a.x - b.x;
  const double y_m = a.y - b.y;
  return x_m * x_m + y_m * y_m < kSameM * kSameM && std::abs(turn_between(a.theta, b.theta)) < radians(10.0);
}

bool is_within(const Pose2& pose, const Pose2& other, double distance_m, double turn_rad) {
  return distance_between(pose, other) < distance_m && std::abs(turn_between(pose.theta, other.theta)) < turn_rad;
}

HypothesisBank::HypothesisBank() { hypotheses_.reserve(kMost + 1); }

void HypothesisBank::clear() {
  hypotheses_.clear();
  believing_ = false;
}

void HypothesisBank::believe(const Pose2& map_from_robot) {
  if (!believing_) {
    hypotheses_.clear();
    hypotheses_.push_back({});
    believing_ = true;
  }
  hypotheses_.front().map_from_robot = map_from_robot;
}

void HypothesisBank::believe_among(const Pose2& map_from_robot) {
  auto chosen = std::find_if(hypotheses_.begin(), hypotheses_.end(), [&](const PoseHypothesis& hypothesis) {
    return is_same(hypothesis.map_from_robot, map_from_robot);
  });
  if (chosen == hypotheses_.end()) return believe(map_from_robot);
  std::swap(hypotheses_.front(), *chosen);
  hypotheses_.front().map_from_robot = map_from_robot;
  hypotheses_.front().log_prior = 0.0;
  believing_ = true;
}

void HypothesisBank::forget_kidnapping() {
  for (PoseHypothesis& hypothesis : hypotheses_) hypothesis.since_kidnapping = hypothesis.lost_since = 0.0;
}

void HypothesisBank::predict(const Pose2& motion) {
  const double driven_m = motion.position().norm();
  for (PoseHypothesis& hypothesis : hypotheses_) {
    hypothesis.map_from_robot = hypothesis.map_from_robot * motion;
    hypothesis.followed_m += driven_m;
  }
}

void HypothesisBank::refine(PoseHypothesis& hypothesis, const sensor::LikelihoodField& field,
                            const motion::BeamEnds& ends, double unknown_s) const {
  const sensor::RefinementParams refinement{.steps = 2, .prior_share = 1.0};
  const double loose_m = 0.06 + 0.3 * unknown_s;
  const double loose_rad = radians(3.0) + 0.3 * unknown_s;
  const PoseCovariance loose =
      Eigen::Vector3d{loose_m * loose_m, loose_m * loose_m, loose_rad * loose_rad}.asDiagonal();
  const double beam_share = std::min(1.0, 20.0 / static_cast<double>(ends.size()));
  const sensor::RefinedPose refined =
      sensor::refined(field, ends, {hypothesis.map_from_robot, loose}, beam_share, refinement);
  hypothesis.map_from_robot = refined.map_from_robot;
  hypothesis.covariance = refined.covariance;
}

void HypothesisBank::refine(const sensor::LikelihoodField& field, const motion::BeamEnds& ends, std::size_t count,
                            double unknown_s) {
  // The believed one too: hypotheses refined to their best fit would beat it by a hair at each scan.
  if (believing_ && !hypotheses_.empty() && ends.size() > 0) refine(hypotheses_.front(), field, ends, unknown_s);
  refine_others(field, ends, count, unknown_s);
}

void HypothesisBank::refine_others(const sensor::LikelihoodField& field, const motion::BeamEnds& ends,
                                   std::size_t count, double unknown_s) {
  constexpr double kClose = 5.0;
  const std::size_t first = believing_ ? 1 : 0;
  if (hypotheses_.empty() || ends.size() == 0) return;
  const double close = odds_of(*reference()) - kClose;
  const std::size_t others = hypotheses_.size() - first;
  if (others == 0) return;
  for (std::size_t i = 0; i < others; ++i) {
    const std::size_t after = (i + others - next_to_refine_ % others) % others;  // how soon its turn comes
    PoseHypothesis& hypothesis = hypotheses_[first + i];
    if (after < count || odds_of(hypothesis) > close) refine(hypothesis, field, ends, unknown_s);
  }
  next_to_refine_ = (next_to_refine_ + count) % others;
}

void HypothesisBank::weigh(const sensor::LikelihoodField& field, const motion::BeamEnds& ends,
                           std::span<const float> weights, double evidence_weight) {
  double of_believed = 0.0;
  for (PoseHypothesis& hypothesis : hypotheses_) {
    const double says = kEvidenceOfABeam * weighted_log_likelihood(field, ends, weights, hypothesis.map_from_robot);
    hypothesis.log_evidence = kKept * hypothesis.log_evidence + says;
    if (&hypothesis == &hypotheses_.front()) of_believed = says;
    const double since_kidnapping = kKept * hypothesis.since_kidnapping + evidence_weight * (says - of_believed);
    hypothesis.since_kidnapping = believing_ ? std::max(0.0, since_kidnapping) : 0.0;
    if (hypothesis.since_kidnapping == 0.0) {
      hypothesis.lost_since = 0.0;
    } else {
      const Comparison beside = compared(field, ends, weights, hypothesis.map_from_robot,
                                         hypotheses_.front().map_from_robot, kEvidenceOfABeam);
      hypothesis.lost_since = kKept * hypothesis.lost_since + evidence_weight * beside.lost;
    }
  }
}

bool HypothesisBank::knows(const Pose2& pose) const {
  return std::any_of(hypotheses_.begin(), hypotheses_.end(),
                     [&](const PoseHypothesis& hypothesis) { return is_same(hypothesis.map_from_robot, pose); });
}

const PoseHypothesis* HypothesisBank::reference() const {
  if (hypotheses_.empty()) return nullptr;
  if (believing_) return &hypotheses_.front();
  return &*std::max_element(hypotheses_.begin(), hypotheses_.end(),
                            [](const PoseHypothesis& a, const PoseHypothesis& b) { return odds_of(a) < odds_of(b); });
}

void HypothesisBank::admit(const PoseHypothesis& hypothesis) {
  if (knows(hypothesis.map_from_robot)) return;
  const auto room = believing_ && !has_more_room_ ? kMostWhileBelieving : kMost;
  const std::size_t first = believing_ ? 1 : 0;
  if (hypotheses_.size() < room + first) {
    hypotheses_.push_back(hypothesis);
    return;
  }
  const auto worst =
      std::min_element(hypotheses_.begin() + static_cast<std::ptrdiff_t>(first), hypotheses_.end(),
                       [](const PoseHypothesis& a, const PoseHypothesis& b) { return odds_of(a) < odds_of(b); });
  if (worst != hypotheses_.end() && odds_of(*worst) < odds_of(hypothesis)) *worst = hypothesis;
}

void HypothesisBank::settle() {
  const PoseHypothesis* const held_against = reference();
  if (held_against == nullptr) return;
  const double hopeless = held_against->log_evidence - kHopeless;
  std::size_t kept = 0;
  for (std::size_t i = 0; i < hypotheses_.size(); ++i) {
    const bool believed = believing_ && i == 0;
    if (!believed && hypotheses_[i].log_evidence < hopeless) continue;
    std::size_t twin = 0;
    while (twin < kept && !is_same(hypotheses_[twin].map_from_robot, hypotheses_[i].map_from_robot)) ++twin;
    if (twin == kept) {
      hypotheses_[kept++] = hypotheses_[i];
    } else if (!(believing_ && twin == 0) && odds_of(hypotheses_[twin]) < odds_of(hypotheses_[i])) {
      const double followed_m = std::max(hypotheses_[twin].followed_m, hypotheses_[i].followed_m);
      const PoseHypothesis& longer =
          hypotheses_[twin].since_kidnapping > hypotheses_[i].since_kidnapping ? hypotheses_[twin] : hypotheses_[i];
      const double since_kidnapping = longer.since_kidnapping;
      const double lost_since = longer.lost_since;
      hypotheses_[twin] = hypotheses_[i];
      hypotheses_[twin].followed_m = followed_m;
      hypotheses_[twin].since_kidnapping = since_kidnapping;
      hypotheses_[twin].lost_since = lost_since;
    }
  }
  hypotheses_.resize(kept);

  double best = odds_of(hypotheses_.front());
  for (const PoseHypothesis& hypothesis : hypotheses_) best = std::max(best, odds_of(hypothesis));
  double sum = 0.0;
  for (PoseHypothesis& hypothesis : hypotheses_) {
    hypothesis.share = std::exp(odds_of(hypothesis) - best);
    sum += hypothesis.share;
  }
  for (PoseHypothesis& hypothesis : hypotheses_) hypothesis.share /= sum;
}

}  // namespace deltamap::localization::hypotheses
