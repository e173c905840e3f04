// SPDX-License-Identifier: Apache-2.0
// Follows the aliases of the believed pose, so that P(pose right) falls at once when the robot may have been carried to
// one. It examines poses whose heading differs from the believed one by right angles: most aliases in buildings do.
// It collects evidence only; no alias is believed because it is monitored, since among poses that are examined again
// and again one would sooner or later win by chance.
#pragma once

#include <span>

#include "localization/hypotheses/hypothesis_bank.hpp"
#include "localization/hypotheses/lattice_search.hpp"
#include "localization/hypotheses/scan_stack.hpp"
#include "localization/sensor/coarse_field.hpp"

namespace deltamap::localization::hypotheses {

class AliasMonitor {
 public:
  struct Effort {
    int probes;    ///< poses turned by right angles that are looked at in a scan; >= 0
    int refined;   ///< hypotheses that are refined to their best fit in a scan, beside those that come close; >= 0
    double prior;  ///< odds of one against the believed pose, before any scan; 0..1
  };
  explicit AliasMonitor(const Effort& effort);

  void clear() { bank_.clear(); }
  void predict(const Pose2& motion) { bank_.predict(motion); }

  struct Seen {
    const sensor::LikelihoodField& field;
    const sensor::CoarseField& coarse;
    const motion::BeamEnds& ends;
    const motion::BeamEnds& near_ends;  ///< that a coarse lattice can place
    Pose2 map_from_believed;            ///< refined to where the scan fits, as its aliases will be
    Pose2 continuous_odom_from_robot;
    const ScanStack& stack;
    double evidence_weight = 1.0;      ///< how much beams that miss say, [0, 1]
    std::span<const float> weights{};  ///< of the beams, where the scan tells something new
    double unknown_s = 0.0;
  };
  /// Every scan beside a believed pose, after predict().
  void observe(const Seen& seen);

  /// The believed pose and its aliases.
  [[nodiscard]] const HypothesisBank& hypotheses() const { return bank_; }

 private:
  void probe(const Seen& seen);
  void admit(const Pose2& rough, const Seen& seen);

  Effort effort_;
  HypothesisBank bank_;
  LatticeSearch lattice_;
  motion::BeamEnds turned_;  // to the believed heading
  double own_fit_ = 0.0;     // mean ln p(z) of the scan at the believed pose
};

}  // namespace deltamap::localization::hypotheses
