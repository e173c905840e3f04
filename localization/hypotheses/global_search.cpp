// SPDX-License-Identifier: Apache-2.0
#include "localization/hypotheses/global_search.hpp"

#include <algorithm>
#include <cmath>

#include "localization/sensor/pose_refinement.hpp"
#include "localization/sensor/weighing.hpp"

namespace deltamap::localization::hypotheses {
Pose2 settled(const sensor::LikelihoodField& field, const motion::BeamEnds& ends, const Pose2& pose) {
  // The field pulls over two or three decimetres; a heading between two of the lattice may be farther off.
  constexpr double kStepM = 0.1;
  const double step_rad = radians(2.5);
  Pose2 best = pose;
  std::int32_t least = sensor::misfit_steps(field, ends, best);
  for (const double share : {1.0, 1.0, 0.5}) {
    const Pose2 from = best;
    const double by_m = share * kStepM;
    const double by_rad = share * step_rad;
    for (const Pose2& by : {Pose2{0, 0, by_rad}, Pose2{0, 0, -by_rad}, Pose2{by_m, 0, 0}, Pose2{-by_m, 0, 0},
                            Pose2{0, by_m, 0}, Pose2{0, -by_m, 0}}) {
      const Pose2 tried{from.x + by.x, from.y + by.y, wrapped_angle(from.theta + by.theta)};
      const std::int32_t misfit = sensor::misfit_steps(field, ends, tried);
      if (misfit < least) {
        least = misfit;
        best = tried;
      }
    }
  }
  const sensor::RefinementParams refinement{
      .steps = 6, .prior_share = 1.0, .longest_shift_m = 0.6, .largest_turn_rad = 0.35};
  const PoseCovariance loose = Eigen::Vector3d{0.09, 0.09, 0.03}.asDiagonal();
  return sensor::refined(field, ends, {best, loose}, 1.0, refinement).map_from_robot;
}

GlobalSearch::GlobalSearch(const GlobalSearchParams& params, int headings)
    : params_{params},
      lattice_{headings, LatticeSearch::kKeptForEach * static_cast<std::size_t>(std::max(1, params.refined))} {}

void GlobalSearch::start() { stage_ = Stage::kBegin; }

bool GlobalSearch::due_again(const Pose2& continuous_odom_from_robot) const {
  const Pose2 since = motion_between(continuous_odom_from_robot_, continuous_odom_from_robot);
  return since.position().norm() >= params_.again_after_m || std::abs(since.theta) >= params_.again_after_rad;
}

std::span<const Pose2> GlobalSearch::look(const sensor::CoarseField& coarse, const sensor::LikelihoodField& field,
                                          const Ends& ends, const Pose2& continuous_odom_from_robot, bool beside) {
  const SearchShare& share = beside ? params_.beside : params_.alone;
  hypotheses_.clear();
  if (stage_ == Stage::kDone && due_again(continuous_odom_from_robot)) stage_ = Stage::kBegin;
  if (ends.all.size() == 0 || stage_ == Stage::kDone) return hypotheses_;
  if (stage_ == Stage::kBegin) {
    ends_ = ends.near;
    continuous_odom_from_robot_ = continuous_odom_from_robot;
    left_ = lattice_.poses(coarse);
    lattice_.clear();
    stage_ = Stage::kLooking;
  }
  if (stage_ == Stage::kLooking) {
    const std::size_t now = std::min(left_, static_cast<std::size_t>(std::max(1, share.candidates)));
    lattice_.look(coarse, ends_, now);
    left_ -= now;
    if (left_ > 0) return hypotheses_;
    candidates_ = lattice_.best_apart(static_cast<std::size_t>(params_.refined));
    next_ = 0;
    stage_ = Stage::kSliding;
    return hypotheses_;
  }
  // Carried along by the wheels since the scan that found them, and refined to where the newest scan fits.
  const Pose2 motion = motion_between(continuous_odom_from_robot_, continuous_odom_from_robot);
  const std::size_t until = std::min(candidates_.size(), next_ + static_cast<std::size_t>(std::max(1, share.refined)));
  for (; next_ < until; ++next_) {
    hypotheses_.push_back(settled(field, ends.all, candidates_[next_].map_from_robot * motion));
  }
  if (next_ == candidates_.size()) stage_ = Stage::kDone;
  return hypotheses_;
}

}  // namespace deltamap::localization::hypotheses
