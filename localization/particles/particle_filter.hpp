// SPDX-License-Identifier: Apache-2.0
// The particle filter of Thrun, Burgard and Fox, "Probabilistic Robotics", 2005, Table 8.2: moves the particles by the
// motion model, weighs them by a scan, and resamples when too few of them carry the weight.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "core/random.hpp"
#include "core/ziggurat.hpp"
#include "localization/motion/deskew.hpp"
#include "localization/motion/motion_model.hpp"
#include "localization/particles/particle_set.hpp"
#include "localization/sensor/likelihood_field.hpp"
#include "localization/sensor/proposed_pose.hpp"
#include "localization/sensor/scan_segments.hpp"

namespace deltamap::localization::particles {

struct ParticleFilterParams {
  int min = 500;                 ///< fewest particles; 10..max
  int max = 5000;                ///< most: drawn where the pose is unsure by more than 0.15 m or 4°; min..200000
  double resample_below = 0.5;   ///< share of the particles below which N_eff calls for resampling; 0..1
  double evidence_beams = 20.0;  ///< independent beams that a scan counts as at most; > 0
  double kld_error = 0.05;       ///< bound of the approximation error that sets the number of particles; > 0 (ε)
  double kld_quantile = 2.33;    ///< of the normal distribution, how surely the bound holds; > 0 (z)
};

class ParticleFilter {
 public:
  ParticleFilter(const ParticleFilterParams& params, std::uint64_t seed);

  /// Around one pose, normally distributed: `count` particles. `covariance`: x, y and heading in the map frame.
  void start_around(const Pose2& map_from_robot, const PoseCovariance& covariance, std::size_t count);

  void move(const Pose2& motion, double unknown_s, const motion::MotionModelParams& model);

  /// Moves some there, one to each pose; to be called before they are weighed.
  void propose(std::span<const sensor::ProposedPose> poses);

  /// Accumulates the scan into the weights, by segments. Answers each particle's misfit, the sum over all ends
  /// (weighing.hpp); valid until the next call. `ends` must not be empty.
  std::span<const std::int32_t> weigh(const sensor::LikelihoodField& field, const motion::BeamEnds& ends);

  /// N_eff (Eq. 5) of the accumulated weights.
  [[nodiscard]] double n_eff() const;

  /// Moves some of those that were drawn as slipped in the last move there, one to each pose; to be called before they
  /// are weighed.
  void propose_slips(std::span<const Pose2> map_from_robot);
  /// The best was drawn as slipped in the last move.
  [[nodiscard]] bool best_has_slipped() const;
  /// Draws anew by the weights, and moves all but the best by a share of a usual slip: few were to tell how far off
  /// that one may be.
  void spread_chosen(const motion::MotionModelParams& model, double share);
  /// Draws anew where N_eff is low; as many particles as `occupied_cells` cells call for. True where it did.
  bool resample_if_needed(std::size_t occupied_cells);

  [[nodiscard]] const ParticleSet& particles() const { return particles_; }

 private:
  [[nodiscard]] std::size_t best() const;
  void draw(std::size_t count);
  [[nodiscard]] Pose2 beside(const Pose2& map_from_robot, const Eigen::Matrix3d& root_of_covariance);
  void let_some_slip(const motion::MotionModelParams& model);
  void normalize_weights();

  ParticleFilterParams params_;
  Random random_;
  Ziggurat ziggurat_;
  ParticleSet particles_;
  ParticleSet drawn_;
  std::optional<std::uint32_t> first_slip_;  // of the particles that the last move let slip
  std::vector<std::uint32_t> choice_;
  std::vector<sensor::ScanSegment> segments_;
  std::vector<std::int32_t> misfits_;
};

}  // namespace deltamap::localization::particles
