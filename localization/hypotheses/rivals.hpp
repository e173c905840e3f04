// SPDX-License-Identifier: Apache-2.0
// Where else in the map the robot might be. Follows some places beside the believed one, lets every few decimetres of
// driving speak for or against each, and looks through the whole map for further ones, a little at each scan. A place
// that fits as well as the believed one stays a rival for ever; one that fits clearly better for metres wins.
#pragma once

#include <cstdint>
#include <optional>
#include <span>

#include "localization/hypotheses/global_search.hpp"
#include "localization/hypotheses/image_watch.hpp"
#include "localization/hypotheses/place_bank.hpp"
#include "localization/hypotheses/rival_probes.hpp"
#include "localization/hypotheses/rival_report.hpp"
#include "localization/hypotheses/scan_stack.hpp"
#include "localization/hypotheses/surface_novelty.hpp"
#include "localization/hypotheses/usual_misfit.hpp"
#include "localization/sensor/coarse_field.hpp"

namespace deltamap::localization::hypotheses {

struct RivalsParams {
  int probes = 800;                   ///< poses of the whole map that are looked at in a scan while tracking; >= 0
  int probes_nearby = 60;             ///< and around the believed pose: slips; >= 0
  double nearby_m = 1.5;              ///< how far "around" is, m; > 0
  double nearby_rad = radians(20.0);  ///< likewise, rad; > 0
  double nearby_prior = 1e-3;         ///< odds of such a place against the believed one, before any scan; 0..1
  double elsewhere_prior = 1e-5;      ///< odds of any other place: nobody carries robots about; 0..1
  double carried_prior = 0.003;       ///< odds that it has just been carried to one that fits from then on; 0..1
  double prior_after_search = 0.3;    ///< the same where the believed place was not given but found; 0..1
  double kidnapped_prior =
      0.001;  ///< odds of being elsewhere against near, where the believed place has proven wrong; 0..1
  double winning_share = 0.98;   ///< of the belief at which another place is believed instead; 0.5..1
  double wins_after_m = 1.0;     ///< driven since it was found before another place may win, m; >= 0
  double beats_by = 12.0;        ///< log evidence of clearly better, whatever the odds before; > 0
  double held_by = 16.0;         ///< more log evidence against a pose that proven tiles hold; >= 0
  double most_ahead = 10.0;      ///< log evidence that a place may be found with ahead of the believed one; >= 0
  double equal_within = 4.0;     ///< log evidence of about as well; > 0
  int refined_a_scan = 4;        ///< places that are slid to their best fit at a scan while tracking; >= 0
  double block_m = 0.25;         ///< side of the coarse field's blocks, m; > 0
  int headings = 96;             ///< of the lattice of poses; > 0
  double suspicious_pace = 0.2;  ///< of a search of the whole map while a pose is believed; (0, 1]
  int images = 16;               ///< of a place in the map that are remembered; >= 0
  int images_a_scan = 2;         ///< of them looked at again in a scan; >= 0
};

class Rivals {
 public:
  Rivals(const RivalsParams& params, const PlaceBankParams& bank, const GlobalSearchParams& search,
         const OccupancyGrid& map, const sensor::LikelihoodField& field, std::uint64_t seed);

  /// From now on the pose given with each scan is believed; all other places are forgotten.
  void start_believing();
  /// From now on this place is believed, which was not given but found. After a slip the place is near the one that
  /// was believed; elsewhere, all others that fit as well stay its rivals.
  void start_believing_in(const Pose2& found);
  /// From now on nothing is believed and the whole map is searched; known places keep what speaks for them.
  void stop_believing();
  /// While true, the whole map is searched beside the believed pose.
  void suspect(bool suspicious);
  /// As stop_believing(), and forgets all places.
  void start_anywhere();

  struct Seen {
    const motion::BeamEnds& ends;              ///< robot frame; may be empty
    Pose2 joined_from_robot;                   ///< by odometry (OdometryAt)
    std::optional<Pose2> map_from_believed{};  ///< where the robot is believed to be, if anywhere
    double held = 0.0;                         ///< how far proven tiles hold that pose, [0, 1]
    double unknown_s = 0.0;                    ///< seconds since the last scan that odometry does not cover
  };
  const RivalReport& observe(const sensor::LikelihoodField& field, const Seen& seen);

  [[nodiscard]] const RivalReport& report() const { return report_; }
  /// The best place of all while nothing is believed, with the share of all close to it; nothing before a scan has
  /// found one.
  [[nodiscard]] std::optional<Place> best_place() const;
  /// Is the pose about where the robot was last believed to be, carried along by odometry?
  [[nodiscard]] bool is_near_believed(const Pose2& pose) const;
  /// True while a search of the whole map is under way.
  [[nodiscard]] bool searching() const { return search_.under_way(); }

  /// The map has changed within the box (all of it: a box of the whole map).
  void apply(const OccupancyGrid& map, const sensor::LikelihoodField& field, const CellBox& changed);

 private:
  void forget_places();
  void forget_carrying();
  /// Otherwise than odometry says, by more than two places that are one.
  [[nodiscard]] bool has_jumped(const Pose2& map_from_believed) const;
  void thin(const Seen& seen);
  void weigh(const sensor::LikelihoodField& field, const Seen& seen);
  void keep_near_ends();
  void probe(const sensor::LikelihoodField& field, const Pose2& joined);
  void admit_rival(const sensor::LikelihoodField& field, const Pose2& rough, const Pose2& joined, double own_fit);
  void admit_all(const sensor::LikelihoodField& field, std::span<const Pose2> poses, const Pose2& joined);
  /// Of a place that has only now come to mind, against the best that is known.
  struct Odds {
    double ahead = 0.0;      ///< log evidence of the scans of the last metres
    double log_prior = 0.0;  ///< log odds before any scan
  };
  /// Either the robot has just been carried there: then only the scans since that moment speak, but nobody carries
  /// robots about. Or it has been there since the believed place was found, and the search has overlooked it: then all
  /// scans speak. The likelier of the two.
  [[nodiscard]] Odds odds_beside_believed(const ScanStack::Sums& its, const ScanStack::Sums& others) const;
  [[nodiscard]] Odds odds_unbelieved(const Pose2& pose, const ScanStack::Sums& its,
                                     const ScanStack::Sums& others) const;
  /// What a place that has only now come to mind brings with it, had the robot been carried there lately; nothing where
  /// no pose is believed.
  [[nodiscard]] Comparison brought_by(const sensor::LikelihoodField& field, const Pose2& pose,
                                      const Pose2& joined) const;
  [[nodiscard]] double log_prior_unbelieved(const Pose2& pose) const;
  void write_report();

  RivalsParams params_;
  sensor::CoarseField coarse_;
  RivalProbes probes_;
  ImageWatch watch_;
  GlobalSearch search_;
  PlaceBank bank_;
  ScanStack stack_;
  motion::BeamEnds ends_;       // thinned
  motion::BeamEnds near_ends_;  // of these, those that a coarse lattice of headings can place
  SurfaceNovelty novelty_;
  UsualMisfit usual_misfit_;
  std::optional<Pose2> last_joined_;
  bool believing_ = false;
  bool suspicious_ = false;
  double elsewhere_prior_;
  std::optional<Pose2> last_believed_;  // carried along by odometry
  bool probe_nearby_next_ = false;
  double since_step_m_ = 0.0;
  double since_step_rad_ = 0.0;
  RivalReport report_;
  double held_by_ = 0.0;
};

}  // namespace deltamap::localization::hypotheses
