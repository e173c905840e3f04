// SPDX-License-Identifier: Apache-2.0
// Brings surface points onto the map, searching only where the localizer's pose can be: a brute-force search of its ±3σ
// on a distance table, then closest lines with the prior. An axis that the points do not observe (a corridor) is held
// by the prior; a correction that the prior finds implausible (χ²) is refused.
#pragma once

#include <span>
#include <vector>

#include "core/grid/occupancy_grid.hpp"
#include "mapping/merge/merge_refusal.hpp"
#include "mapping/registration/from_pose.hpp"

namespace deltamap::surveying::grid_registration {

/// How well the pose is known from which the points were placed.
struct PosePrior {
  Point2 position_in_map{0.0, 0.0};                    ///< of the robot: headings turn about it
  PoseCovariance covariance = PoseCovariance::Zero();  ///< of the robot's (x, y, θ) in the map
};

struct PriorMergeParams : mapping::registration::FromPoseParams {
  double search_deviations = 3.0;  ///< half width of the search in σ along each axis of the prior; > 0
  double most_search_m = 1.0;      ///< bound of the half width in position
  double most_search_rad = 0.35;   ///< bound of the half width in heading (20°)
  double least_agreement = 0.5;  ///< share of points within 1 cell of an occupied one, of those on known cells; [0, 1]
  double ambiguity_margin = 0.03;  ///< a second pose whose agreement comes this near is one too many; [0, 1]
};

struct PriorMerge {
  mapping::merge::MergeRefusal refusal = mapping::merge::MergeRefusal::kNone;
  Pose2 map_from_guess;  ///< the correction: moves the points onto the map; identity where refused
  PoseCovariance covariance = PoseCovariance::Zero();  ///< of the corrected robot's (x, y, θ), prior included
  double agreement = 0.0;  ///< share of the points within 1 cell of an occupied one after the correction, of those on
                           ///< known cells

  [[nodiscard]] bool accepted() const { return refusal == mapping::merge::MergeRefusal::kNone; }
};

/// A pose that the points may have.
struct PriorAnswer {
  Pose2 map_from_guess;
  PoseCovariance covariance = PoseCovariance::Zero();
  double agreement = 0.0;
  double chi2 = 0.0;  ///< of the correction under the prior
  double cost = 0.0;  ///< -2 ln p of the points and of the prior
};
/// What prior_merge() chooses among: best first, none beside a better one; none where there are fewer points
/// than make a contour; of fewer on known cells the agreement is 0.
[[nodiscard]] std::vector<PriorAnswer> prior_answers(const OccupancyGrid& map,
                                                     std::span<const Point2> surface_points_in_map_guess,
                                                     const PosePrior& prior, const PriorMergeParams& params);
/// What speaks against an answer by itself.
[[nodiscard]] mapping::merge::MergeRefusal refusal_of(const PriorAnswer& answer, const PriorMergeParams& params);

/// `surface_points_in_map_guess`: hits placed in the map by the localizer's poses, only those expected to be found in
/// it.
[[nodiscard]] PriorMerge prior_merge(const OccupancyGrid& map, std::span<const Point2> surface_points_in_map_guess,
                                     const PosePrior& prior, const PriorMergeParams& params);

/// The same for a local map: its contour is brought onto the map, Eq. 11 along its edges tells such answers apart, then
/// these edges are brought to a fraction of a cell. `covariance`: of the place and turn of its middle (the mean of its
/// contour). Both grids must have the same resolution.
[[nodiscard]] PriorMerge prior_merge(const OccupancyGrid& map, const OccupancyGrid& local,
                                     const Pose2& map_from_local_guess, const PoseCovariance& covariance,
                                     const PriorMergeParams& params);

}  // namespace deltamap::surveying::grid_registration
