// SPDX-License-Identifier: Apache-2.0
#include "localization/tracking/slip_finder.hpp"

#include "localization/sensor/weighing.hpp"

namespace deltamap::localization::tracking {
namespace {

constexpr double kSuddenBelow = 0.85;  // of the usual fit
constexpr double kFitsAgainAbove = 0.9;
constexpr double kNewestFit = 0.1;                                                    // share in the usual one
constexpr double kTurnsOfSlip[] = {0.0, -0.3, 0.3, -0.6, 0.6, -1.0, 1.0, -1.6, 1.6};  // deviations, to refine from

}  // namespace

std::span<const Pose2> SlipFinder::slips(const sensor::LikelihoodField& field, const motion::BeamEnds& ends,
                                         const Pose2& by_wheels, double beam_share) {
  slips_.clear();
  if (motion_.slip_probability <= 0.0 || sensor::mean_likelihood(field, ends, by_wheels) >= kSuddenBelow * usual_fit_)
    return slips_;
  const PoseCovariance spread = motion::slip_covariance(motion_, by_wheels.theta);
  for (const double turn : kTurnsOfSlip) {
    const double heading = wrapped_angle(by_wheels.theta + turn * motion_.slip_rad);
    const sensor::RefinedPose from{{by_wheels.x, by_wheels.y, heading}, spread};
    const Pose2 refined = sensor::refined(field, ends, from, beam_share, refinement_).map_from_robot;
    if (sensor::mean_likelihood(field, ends, refined) >= kFitsAgainAbove * usual_fit_) slips_.push_back(refined);
  }
  return slips_;
}

void SlipFinder::learn(const sensor::LikelihoodField& field, const motion::BeamEnds& ends, const Pose2& believed) {
  const double fit = sensor::mean_likelihood(field, ends, believed);
  usual_fit_ += (usual_fit_ > 0.0 ? kNewestFit : 1.0) * (fit - usual_fit_);
}

}  // namespace deltamap::localization::tracking
