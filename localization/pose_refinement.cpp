// SPDX-License-Identifier: Apache-2.0
#include "localization/pose_refinement.hpp"

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>

namespace deltamap::localization {
namespace {

constexpr double kSettledM = 5e-4;
constexpr double kSettledRad = 2e-4;
constexpr double kUnknowns = 3.0;       // of a pose
constexpr double kNewestErrors = 0.05;  // share of one scan in the running means

/// Bilinear between the four centres around the point.
[[gnu::always_inline]] inline FieldDistance distance_between_centres(const LikelihoodField& field, double x_m,
                                                                     double y_m) {
  const LikelihoodField::Bordered bordered = field.bordered();
  const GridGeometry& geometry = field.geometry();
  const double cells_per_m = 1.0 / geometry.resolution_m;
  // In the bordered field the centre of cell (0, 0) lies at (1.5, 1.5); centres are the knots.
  const double x_wanted = (x_m - geometry.origin.x()) * cells_per_m + 0.5;
  const double y_wanted = (y_m - geometry.origin.y()) * cells_per_m + 0.5;
  const double x = std::clamp(x_wanted, 0.0, bordered.width - 1.001);
  const double y = std::clamp(y_wanted, 0.0, bordered.height - 1.001);
  const auto column = static_cast<std::ptrdiff_t>(x);
  const auto row = static_cast<std::ptrdiff_t>(y);
  const double u = x - static_cast<double>(column);
  const double v = y - static_cast<double>(row);
  const std::uint8_t* at = bordered.bytes + row * bordered.width + column;
  const auto& distance = field.distance_of_steps_m();
  const double low_left = static_cast<double>(distance[at[0]]);
  const double low_right = static_cast<double>(distance[at[1]]);
  const double high_left = static_cast<double>(distance[at[bordered.width]]);
  const double high_right = static_cast<double>(distance[at[bordered.width + 1]]);
  if (x != x_wanted || y != y_wanted) return {low_left, {0.0, 0.0}};  // outside the map nothing pulls
  const double low = low_left + u * (low_right - low_left);
  const double high = high_left + u * (high_right - high_left);
  return {
      low + v * (high - low),
      {((1.0 - v) * (low_right - low_left) + v * (high_right - high_left)) * cells_per_m, (high - low) * cells_per_m}};
}

/// Sum over the beams of wJᵀJ/σ² and wJᵀd/σ².
struct NormalEquations {
  Eigen::Matrix3d information = Eigen::Matrix3d::Zero();
  Eigen::Vector3d pull = Eigen::Vector3d::Zero();
  BeamErrors errors;
};

NormalEquations normal_equations(const LikelihoodField& field, const BeamEnds& ends, const Pose2& pose) {
  const double inverse_variance = 1.0 / (field.hit_deviation_m() * field.hit_deviation_m());
  const double random_share = field.params().random_share;
  const double c = std::cos(pose.theta);
  const double s = std::sin(pose.theta);
  NormalEquations sum;
  Eigen::Vector3d information_of_x = Eigen::Vector3d::Zero();  // the upper triangle, row by row
  Eigen::Vector2d information_of_y = Eigen::Vector2d::Zero();
  double information_of_heading = 0.0;
  for (std::size_t i = 0; i < ends.size(); ++i) {
    const double dx = c * static_cast<double>(ends.x_m[i]) - s * static_cast<double>(ends.y_m[i]);
    const double dy = s * static_cast<double>(ends.x_m[i]) + c * static_cast<double>(ends.y_m[i]);
    const FieldDistance at = distance_between_centres(field, pose.x + dx, pose.y + dy);
    if (at.slope.x() == 0.0 && at.slope.y() == 0.0) continue;
    const auto exponent = static_cast<float>(-0.5 * at.distance_m * at.distance_m * inverse_variance);
    const double hit = (1.0 - random_share) * static_cast<double>(std::exp(exponent));
    const double weight = inverse_variance * hit / (hit + random_share);  // probability that the map explains the beam
    const Eigen::Vector3d jacobian{at.slope.x(), at.slope.y(), at.slope.y() * dx - at.slope.x() * dy};
    const Eigen::Vector3d weighted = weight * jacobian;
    information_of_x += weighted.x() * jacobian;
    information_of_y += Eigen::Vector2d{weighted.y() * jacobian.y(), weighted.y() * jacobian.z()};
    information_of_heading += weighted.z() * jacobian.z();
    sum.pull += at.distance_m * weighted;
    const double share = weight / inverse_variance;
    sum.errors.explained += share;
    sum.errors.squares_m2 += share * at.distance_m * at.distance_m;
  }
  const Eigen::Vector3d& x = information_of_x;
  const Eigen::Vector2d& y = information_of_y;
  sum.information << x.x(), x.y(), x.z(), x.y(), y.x(), y.y(), x.z(), y.y(), information_of_heading;
  return sum;
}

Eigen::Vector3d difference(const Pose2& from, const Pose2& to) {
  return {to.x - from.x, to.y - from.y, turn_between(from.theta, to.theta)};
}

}  // namespace

FieldDistance distance_at(const LikelihoodField& field, double x_m, double y_m) {
  return distance_between_centres(field, x_m, y_m);
}

void BeamErrors::blend_in(const BeamErrors& scan, double share) {
  if (explained <= 0.0) share = 1.0;
  const auto blend = [&](double& mean, double value) { mean += share * (value - mean); };
  blend(explained, scan.explained);
  blend(squares_m2, scan.squares_m2);
}

double BeamErrors::variance_m2(const RefinementParams& params) const {
  const double seen_m2 = squares_m2 / std::max(1.0, explained - kUnknowns);
  const double laser_m2 = params.range_deviation_m * params.range_deviation_m;
  return std::clamp(seen_m2, 0.1 * laser_m2, laser_m2) + params.alike_beams * std::max(0.0, seen_m2 - laser_m2);
}

Refinement refined(const LikelihoodField& field, const BeamEnds& ends, const RefinedPose& prior,
                   const PoseCovariance& hold, BeamErrors known, double beam_share, const RefinementParams& params) {
  const Refinement unchanged{prior, known};
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
    if (move.head<2>().norm() < kSettledM && std::abs(move.z()) < kSettledRad) break;
  }
  const Eigen::Vector3d shift = difference(prior.map_from_robot, pose);
  if (shift.head<2>().norm() > params.longest_shift_m || std::abs(shift.z()) > params.largest_turn_rad) {
    return unchanged;
  }
  known.blend_in(beams.errors, kNewestErrors);
  // Whatever the weights were chosen for, the errors that they pass on are those that the beams and the prior have.
  const double error = known.variance_m2(params) / (field.hit_deviation_m() * field.hit_deviation_m());
  const Eigen::Matrix3d of_beams = (beam_share * beam_share * error) * beams.information;
  const Eigen::Matrix3d of_prior = holding * prior.covariance * holding;
  const Eigen::Matrix3d gain = (holding + beam_share * beams.information).inverse();
  return {{pose, gain * (of_beams + of_prior) * gain}, known};
}

}  // namespace deltamap::localization
