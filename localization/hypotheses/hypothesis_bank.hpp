// SPDX-License-Identifier: Apache-2.0
// The pose hypotheses that are followed, the believed one first where a pose is believed. Each is predicted by
// odometry, refined a little at each scan, and collects log evidence: what the independent beams of decorrelated scans
// say, with a memory that fades over metres. Hypotheses that meet are joined, hopeless ones are given up.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "core/geometry/angle.hpp"
#include "localization/motion/deskew.hpp"
#include "localization/sensor/likelihood_field.hpp"
#include "localization/sensor/pose_refinement.hpp"

namespace deltamap::localization::hypotheses {

struct PoseHypothesis {
  Pose2 map_from_robot;
  PoseCovariance covariance = PoseCovariance::Zero();
  double log_evidence = 0.0;
  double log_prior = 0.0;
  double share = 0.0;
  double followed_m = 0.0;
  double since_kidnapping = 0.0;  ///< log evidence against the believed one, since when it speaks for it most; >= 0
  double lost_since = 0.0;        ///< of that what beams that fit the believed one better have taken away; >= 0
};

/// What a scan says of a hypothesis beside another.
struct Comparison {
  double gained = 0.0;  ///< log evidence from beams that fit the hypothesis better
  double lost = 0.0;    ///< from beams that fit the other one better
  [[nodiscard]] double ahead() const { return gained - lost; }
};

/// Mean over the beams of ln p(z) with the robot at the pose. 0 without beams.
[[nodiscard]] double mean_log_likelihood(const sensor::LikelihoodField& field, const motion::BeamEnds& ends,
                                         const Pose2& pose);

/// Sum over the beams of weight · ln p(z): what a scan says, the less the fewer beams it has.
[[nodiscard]] double weighted_log_likelihood(const sensor::LikelihoodField& field, const motion::BeamEnds& ends,
                                             std::span<const float> weights, const Pose2& pose);

/// Where each beam, times its weight, counts as `of_a_beam` independent ones.
[[nodiscard]] Comparison compared(const sensor::LikelihoodField& field, const motion::BeamEnds& ends,
                                  std::span<const float> weights, const Pose2& hypothesis, const Pose2& other,
                                  double of_a_beam);

[[nodiscard]] bool is_within(const Pose2& pose, const Pose2& other, double distance_m, double turn_rad);

/// Two hypotheses so near each other are one.
[[nodiscard]] bool is_same(const Pose2& a, const Pose2& b);

class HypothesisBank {
 public:
  static constexpr std::size_t kMost = 200;  ///< hypotheses while nothing is believed
  static constexpr std::size_t kBeams = 60;  ///< of a scan, at most, that judge a hypothesis
  /// Independent beams that each of them counts as where it hits a new surface.
  static constexpr double kEvidenceOfABeam = 0.2;
  /// Driven or turned until a scan tells something new.
  static constexpr double kStepM = 0.2;
  static constexpr double kStepRad = radians(15.0);

  HypothesisBank();

  [[nodiscard]] std::span<const PoseHypothesis> hypotheses() const { return hypotheses_; }
  /// Without the believed one.
  [[nodiscard]] std::span<const PoseHypothesis> others() const {
    return hypotheses().subspan(believing_ && !hypotheses_.empty() ? 1 : 0);
  }
  /// The one that is believed, if any; always the first.
  [[nodiscard]] bool believing() const { return believing_; }

  /// Room for kMost hypotheses beside a believed one too, as long as it is wanted.
  void make_room(bool wanted) { has_more_room_ = wanted; }

  void clear();
  /// The first hypothesis from now on; its pose is given, not followed.
  void believe(const Pose2& map_from_robot);
  /// The hypothesis at this pose is believed from now on; all others stay, with the evidence that they have.
  void believe_among(const Pose2& map_from_robot);
  /// Odds before any scan of each hypothesis anew, as its pose has them.
  template <typename PriorOf>
  void set_priors(PriorOf&& log_prior_of) {
    for (PoseHypothesis& hypothesis : hypotheses_) hypothesis.log_prior = log_prior_of(hypothesis.map_from_robot);
  }
  /// Log odds of the believed one, before any scan.
  void set_believed_prior(double log_prior) {
    if (believing_ && !hypotheses_.empty()) hypotheses_.front().log_prior = log_prior;
  }
  /// What speaks for other poses since the robot may have been carried there spoke against a pose that is believed no
  /// longer.
  void forget_kidnapping();
  /// The believed one becomes a hypothesis like all others, with the evidence that it has.
  void stop_believing() { believing_ = false; }

  void predict(const Pose2& motion);
  /// Refines `count` hypotheses, a round after the other, those that come close to the best one and the believed one
  /// always.
  void refine(const sensor::LikelihoodField& field, const motion::BeamEnds& ends, std::size_t count, double unknown_s);
  /// The same for all but the believed one.
  void refine_others(const sensor::LikelihoodField& field, const motion::BeamEnds& ends, std::size_t count,
                     double unknown_s);
  /// Once for each decorrelated scan. `evidence_weight`: how much of it counts as evidence since the robot may have
  /// been carried, [0, 1].
  void weigh(const sensor::LikelihoodField& field, const motion::BeamEnds& ends, std::span<const float> weights,
             double evidence_weight = 1.0);
  /// A new hypothesis, unless it is known. Takes the room of a worse one where the bank is full.
  void admit(const PoseHypothesis& hypothesis);
  /// Joins hypotheses that have come together, gives up hopeless ones, shares the belief.
  void settle();

  /// The hypothesis that new ones are held against; nothing while there is none.
  [[nodiscard]] const PoseHypothesis* reference() const;
  [[nodiscard]] bool knows(const Pose2& pose) const;

 private:
  void refine(PoseHypothesis& hypothesis, const sensor::LikelihoodField& field, const motion::BeamEnds& ends,
              double unknown_s) const;

  std::vector<PoseHypothesis> hypotheses_;
  bool believing_ = false;
  bool has_more_room_ = false;
  std::size_t next_to_refine_ = 0;
};

}  // namespace deltamap::localization::hypotheses
