// SPDX-License-Identifier: Apache-2.0
// Multi-hypothesis tracking: where else in the map might the robot be? Beside the believed pose some hypotheses are
// followed; each scan that tells something new speaks for or against each, and new hypotheses are searched for in the
// whole map, a little at each scan. A hypothesis that fits as well as the believed pose is followed for ever; one that
// fits clearly better for metres is believed in its place.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "localization/hypotheses/alias_monitor.hpp"
#include "localization/hypotheses/beam_decorrelation.hpp"
#include "localization/hypotheses/global_search.hpp"
#include "localization/hypotheses/hypothesis_bank.hpp"
#include "localization/hypotheses/hypothesis_probes.hpp"
#include "localization/hypotheses/hypothesis_report.hpp"
#include "localization/hypotheses/outlier_rate.hpp"
#include "localization/hypotheses/prior_search.hpp"
#include "localization/hypotheses/scan_stack.hpp"
#include "localization/sensor/coarse_field.hpp"

namespace deltamap::localization::hypotheses {

struct HypothesisTrackerParams {
  int probes = 800;                    ///< poses of the whole map that are looked at in a scan while tracking; >= 0
  int probes_nearby = 60;              ///< and around the believed pose: slips; >= 0
  double nearby_prior = 1e-3;          ///< odds of such a hypothesis against the believed one, before any scan; 0..1
  double elsewhere_prior = 1e-5;       ///< odds of any other hypothesis: nobody carries robots about; 0..1
  double kidnapped_now_prior = 0.003;  ///< odds that it was just carried to one that fits, if a scan broke off; 0..1
  double prior_after_search = 0.3;     ///< the same where the believed pose was not given but found; 0..1
  double kidnapped_prior =
      0.001;               ///< odds of being elsewhere against near, where the believed pose has proven wrong; 0..1
  double beats_by = 12.0;  ///< log evidence of clearly better, whatever the odds before; > 0
  double stable_support_nats = 16.0;  ///< more log evidence against a pose that proven tiles support; >= 0
  double most_ahead = 10.0;  ///< log evidence that a hypothesis may be found with ahead of the believed one; >= 0
  int refined_a_scan = 4;    ///< hypotheses that are refined to their best fit at a scan while tracking; >= 0
  double block_m = 0.25;     ///< side of the coarse field's blocks, m; > 0
  int headings = 96;         ///< of the lattice of poses; > 0
};

class HypothesisTracker {
 public:
  HypothesisTracker(const HypothesisTrackerParams& params, const GlobalSearchParams& search, const OccupancyGrid& map,
                    const sensor::LikelihoodField& field, std::uint64_t seed);

  /// From now on the pose given with each scan is believed; all others are forgotten.
  void start_believing();
  /// From now on this hypothesis is believed, which was not given but found. After a slip it is near the one that
  /// was believed; elsewhere, all others that fit as well are still followed.
  void start_believing_in(const Pose2& found);
  /// From now on nothing is believed and the whole map is searched; known hypotheses keep what speaks for them.
  void stop_believing();
  /// While true, the whole map is searched beside the believed pose, slowly.
  void suspect(bool suspicious);
  /// As stop_believing(), and forgets all hypotheses.
  void start_anywhere();

  struct Seen {
    const motion::BeamEnds& ends;              ///< robot frame; may be empty
    Pose2 continuous_odom_from_robot;          ///< by odometry (OdometryAt)
    std::optional<Pose2> map_from_believed{};  ///< where the robot is believed to be, if anywhere
    double stable_support = 0.0;               ///< how far proven tiles support that pose (StableSupport), [0, 1]
    double unknown_s = 0.0;                    ///< seconds since the last scan that odometry does not cover
    bool kidnapped = false;                    ///< lately, by all signs (Continuity): it is searched for at full pace
  };
  const HypothesisReport& observe(const sensor::LikelihoodField& field, const Seen& seen);

  [[nodiscard]] const HypothesisReport& report() const { return report_; }
  /// The best hypothesis of all while nothing is believed, with the share of all close to it; nothing before a scan has
  /// found one.
  [[nodiscard]] std::optional<PoseHypothesis> best_hypothesis() const;
  /// Is the pose about where the robot was last believed to be, predicted by odometry?
  [[nodiscard]] bool is_near_believed(const Pose2& pose) const;

  /// Where the scan fits within a wide prior of the pose (prior_search.hpp).
  [[nodiscard]] std::vector<sensor::ProposedPose> poses_within(const sensor::RefinedPose& prior,
                                                               const sensor::LikelihoodField& field,
                                                               const motion::BeamEnds& ends);

  /// The map has changed within the box (all of it: a box of the whole map).
  void apply(const OccupancyGrid& map, const sensor::LikelihoodField& field, const CellBox& changed);

 private:
  void forget_hypotheses();
  void forget_kidnapping();
  /// Otherwise than odometry says, by more than joins two hypotheses.
  [[nodiscard]] bool has_jumped(const Pose2& map_from_believed) const;
  void thin(const motion::BeamEnds& ends);
  /// Is the whole map searched, alone or beside the believed pose?
  [[nodiscard]] bool searches() const { return !believing_ || suspicious_ || kidnapped_; }
  /// The first scans at a place tell all that there is to see from it.
  [[nodiscard]] bool tells_more();
  void look(const sensor::LikelihoodField& field, const Seen& seen);
  void weigh(const sensor::LikelihoodField& field, const Seen& seen);
  void keep_near_ends();
  void probe(const sensor::LikelihoodField& field, const Pose2& odom);
  void admit_beside_believed(const sensor::LikelihoodField& field, const Pose2& rough, const Pose2& odom,
                             double own_fit);
  void admit_all(const sensor::LikelihoodField& field, std::span<const Pose2> poses, const Pose2& odom);
  /// How far the robot has driven and turned.
  struct Way {
    double driven_m = 0.0;
    double turned_rad = 0.0;

    void add(const Pose2& motion);
    [[nodiscard]] bool reaches(double metres, double radians) const {
      return driven_m >= metres || turned_rad >= radians;
    }
  };
  /// Of a new hypothesis, against the best that is known.
  struct Odds {
    double ahead = 0.0;      ///< log evidence of the scans of the last metres
    double log_prior = 0.0;  ///< log odds before any scan
  };
  /// Either the robot has just been carried there: then only the scans since that moment speak, but nobody carries
  /// robots about. Or it has been there since the believed pose was found, and the search has overlooked it: then all
  /// scans speak. The likelier of the two.
  [[nodiscard]] Odds odds_beside_believed(const ScanStack::Sums& its, const ScanStack::Sums& others) const;
  [[nodiscard]] Odds odds_unbelieved(const Pose2& pose, const ScanStack::Sums& its,
                                     const ScanStack::Sums& others) const;
  /// What a new hypothesis brings with it, had the robot been carried there lately; nothing where
  /// no pose is believed.
  [[nodiscard]] Comparison brought_by(const sensor::LikelihoodField& field, const Pose2& pose, const Pose2& odom) const;
  [[nodiscard]] double log_prior_unbelieved(const Pose2& pose) const;
  void write_report();

  HypothesisTrackerParams params_;
  sensor::CoarseField coarse_;
  HypothesisProbes probes_;
  AliasMonitor alias_monitor_;
  GlobalSearch search_;
  HypothesisBank bank_;
  ScanStack stack_;
  motion::BeamEnds ends_;       // thinned
  motion::BeamEnds near_ends_;  // of these, those that a coarse lattice of headings can place
  BeamDecorrelation decorrelation_;
  OutlierRate outlier_rate_;
  std::optional<Pose2> last_odom_;
  bool believing_ = false;
  bool suspicious_ = false;
  bool kidnapped_ = false;
  double elsewhere_prior_;
  std::optional<Pose2> last_believed_;  // predicted by odometry
  bool probe_nearby_next_ = false;
  Way since_step_;
  Way since_place_;
  int looks_at_place_ = 0;
  HypothesisReport report_;
  double support_nats_ = 0.0;
};

}  // namespace deltamap::localization::hypotheses
