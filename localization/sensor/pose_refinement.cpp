// SPDX-License-Identifier: Apache-2.0
// Why refine: particles and the poses of a lattice lie centimetres apart, and the best of them is no better than that.
// The field has a gradient, so a few Gauss-Newton steps find the maximum between them.
#include "localization/sensor/pose_refinement.hpp"

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>

#include "localization/sensor/normal_equations.hpp"

namespace deltamap::localization::sensor {
namespace {

constexpr double kUnknowns = 3.0;       // of a pose
constexpr double kNewestErrors = 0.05;  // share of one scan in the running means

}  // namespace

bool is_settled(const Eigen::Vector3d& step) { return step.head<2>().norm() < 5e-4 && std::abs(step.z()) < 2e-4; }

void BeamErrors::blend_in(const BeamErrors& scan, double share) {
  if (explained <= 0.0) share = 1.0;
  const auto blend = [&](double& mean, double value) { mean += share * (value - mean); };
  blend(explained, scan.explained);
  blend(squares_m2, scan.squares_m2);
}

double BeamErrors::variance_m2(double range_deviation_m, double alike_beams) const {
  const double seen_m2 = squares_m2 / std::max(1.0, explained - kUnknowns);
  const double laser_m2 = range_deviation_m * range_deviation_m;
  return std::clamp(seen_m2, 0.1 * laser_m2, laser_m2) + alike_beams * std::max(0.0, seen_m2 - laser_m2);
}

Refinement refined(const LikelihoodField& field, const motion::BeamEnds& ends, const RefinedPose& prior,
                   const PoseCovariance& hold, BeamErrors known, double beam_share, const RefinementParams& params) {
  Refinement unchanged{prior, known};
  if (params.steps <= 0 || ends.size() == 0) return unchanged;
  // A floor keeps the prior invertible when all particles have come to lie on one point.
  const Eigen::Matrix3d spread = hold + Eigen::Vector3d{1e-6, 1e-6, 1e-7}.asDiagonal().toDenseMatrix();
  const Eigen::Matrix3d holding = params.prior_share * spread.inverse();
  Pose2 pose = prior.map_from_robot;
  NormalEquations beams;
  for (int step = 0; step < params.steps; ++step) {
    beams = normal_equations(field, ends, pose);
    const Eigen::Vector3d pull = beam_share * beams.pull + holding * difference(prior.map_from_robot, pose);
    const Eigen::Vector3d move = -(holding + beam_share * beams.information).ldlt().solve(pull);
    if (!move.allFinite()) return unchanged;
    pose = {pose.x + move.x(), pose.y + move.y(), wrapped_angle(pose.theta + move.z())};
    if (is_settled(move)) break;
  }
  const Eigen::Vector3d shift = difference(prior.map_from_robot, pose);
  if (shift.head<2>().norm() > params.longest_shift_m || std::abs(shift.z()) > params.largest_turn_rad) {
    return unchanged;
  }
  known.blend_in({beams.explained, beams.squares_m2}, kNewestErrors);
  // Whatever the weights were chosen for, the errors that they pass on are those that the beams and the prior have.
  const double error = known.variance_m2(ends.range_deviation_m, params.alike_beams) /
                       (field.hit_deviation_m() * field.hit_deviation_m());
  const Eigen::Matrix3d of_beams = (beam_share * beam_share * error) * beams.information;
  const Eigen::Matrix3d of_prior = holding * prior.covariance * holding;
  const Eigen::Matrix3d gain = (holding + beam_share * beams.information).inverse();
  return {{pose, gain * (of_beams + of_prior) * gain}, known};
}

}  // namespace deltamap::localization::sensor
