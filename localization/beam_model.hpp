// SPDX-License-Identifier: Apache-2.0
// The beam model of Thrun, Burgard and Fox, "Probabilistic Robotics", 2005, Table 6.1, for comparison with the
// likelihood field: each beam is followed through the map to where it should end, and its range is held against that.
// It knows that things stand in front of walls, and costs a hundred times as much.
#pragma once

#include <cstdint>
#include <vector>

#include "core/occupancy_grid.hpp"
#include "core/pose2.hpp"
#include "localization/deskew.hpp"

namespace deltamap::localization {

enum class ScanModel : std::uint8_t { kLikelihoodField, kBeam };

/// What remains of 1 - short - max - random is the share of hits (z_hit).
struct BeamModelParams {
  double hit_deviation_m = 0.07;  ///< of laser and map together, m; > 0 (σ_hit)
  double short_share = 0.1;       ///< of beams that something unmapped stops; 0..0.3 (z_short)
  double short_per_m = 0.3;       ///< how thick it stands, 1/m; > 0 (λ_short)
  double max_share = 0.02;        ///< of beams that bring nothing back; 0..0.3 (z_max)
  double random_share = 0.1;      ///< of beams that nothing explains; 0.001..0.3 (z_rand)
};

/// Free of any map: how likely a range is where another is expected.
class BeamLikelihood {
 public:
  BeamLikelihood(const BeamModelParams& params, double max_range_m);

  /// Density of z over [0, max_range_m), 1/m; integrates to 1 with at_maximum().
  [[nodiscard]] double density(double range_m, double expected_m) const;
  /// Probability that the beam brings nothing back.
  [[nodiscard]] double at_maximum() const { return params_.max_share; }
  /// -ln of the density's share of its greatest possible value, in steps of LikelihoodField::kStep; 0 or more.
  [[nodiscard]] std::int32_t steps(double range_m, double expected_m) const;

 private:
  [[nodiscard]] double hit_share() const;

  BeamModelParams params_;
  double max_range_m_;
  double greatest_;  ///< density
};

class BeamModel {
 public:
  BeamModel(const OccupancyGrid& map, const BeamModelParams& params, double max_range_m);

  /// Where a beam from a point of the map should end, m; at most the maximum range. The edge of known space ends it
  /// too.
  [[nodiscard]] double expected_range_m(const Point2& from, double direction_rad) const;

  /// Σ over the ends of the steps of -ln p(z), with the robot at the pose and the laser at `robot_from_laser` on it: to
  /// be used as misfit_steps() of weighing.hpp.
  [[nodiscard]] std::int32_t misfit_steps(const BeamEnds& ends, const Point2& robot_from_laser,
                                          const Pose2& map_from_robot) const;

 private:
  GridGeometry geometry_;
  BeamLikelihood likelihood_;
  double max_range_m_;
  std::vector<std::uint8_t> clear_cells_;  ///< to the nearest cell that ends a beam, along columns or rows; 0 in one
};

}  // namespace deltamap::localization
