// SPDX-License-Identifier: Apache-2.0
// Why lines and a reach that shrinks: a point may slide along a wall freely, as it should; far pairs lead the first
// steps, near ones alone decide the last, so that what is not the same surface drops out.
#include "mapping/registration/registration.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

#include "core/geometry/points_in_map.hpp"
#include "core/geometry/principal_axes.hpp"

namespace deltamap::mapping::registration {
namespace {

constexpr double kReachShrink = 0.8;   // per iteration, from the first reach to the last
constexpr double kDamping = 1e-6;      // of the mean curvature: holds what nothing observes
constexpr double kNormalNoise = 0.01;  // mean square error of a normal, rad²: curvature of the stronger axis that leaks

struct PairSums {
  Eigen::Matrix3d matrix = Eigen::Matrix3d::Zero();  // Σ w gᵀg, no unit deviation yet
  Eigen::Vector3d right_side = Eigen::Vector3d::Zero();
  double squares = 0.0;
  std::size_t paired = 0;
};

PairSums sums_over_pairs(std::span<const Point2> points, const NearestSurface& reference, const Pose2& pose,
                         double reach_m) {
  PairSums sums;
  const PointsInMap in_reference{pose};
  // The lower half of the matrix, number by number: this loop is most of what a registration costs.
  double xx = 0.0, yx = 0.0, yy = 0.0, tx = 0.0, ty = 0.0, tt = 0.0;
  for (const Point2& point : points) {
    const Point2 place = in_reference(point);
    const SurfacePoint* line = reference.nearest(place);
    if (line == nullptr) continue;
    const Point2 apart = place - line->position;
    if (apart.squaredNorm() > reach_m * reach_m) continue;
    const Point2 arm = place - pose.position();
    const Point2& normal = line->normal;
    const double distance_m = normal.dot(apart);
    const double turn = -normal.x() * arm.y() + normal.y() * arm.x();  // of the distance with the heading
    const double share = distance_m / reach_m;
    const double weight =
        (1.0 - share * share) * (1.0 - share * share);  // Tukey: nothing jumps at the border of the reach
    const double wx = weight * normal.x();
    const double wy = weight * normal.y();
    const double wt = weight * turn;
    xx += wx * normal.x(), yx += wy * normal.x(), yy += wy * normal.y();
    tx += wt * normal.x(), ty += wt * normal.y(), tt += wt * turn;
    sums.right_side.x() -= wx * distance_m, sums.right_side.y() -= wy * distance_m;
    sums.right_side.z() -= wt * distance_m;
    sums.squares += distance_m * distance_m;
    ++sums.paired;
  }
  sums.matrix << xx, yx, tx, yx, yy, ty, tx, ty, tt;
  return sums;
}

/// Noise in the normals pretends to observe the length of a corridor: its share of the curvature is taken off the
/// weaker axis, so that the covariance does not promise it.
Eigen::Matrix3d without_normal_noise(const Eigen::Matrix3d& information) {
  const PrincipalAxes axes = principal_axes(information.topLeftCorner<2, 2>());
  const double weaker = axes.values[0];
  if (weaker <= 0.0) return information;
  const double left = std::max(0.0, 1.0 - kNormalNoise * axes.values[1] / weaker);
  const Eigen::Vector2d axis = axes.vectors.col(0);
  Eigen::Matrix3d scale = Eigen::Matrix3d::Identity();
  scale.topLeftCorner<2, 2>() -= (1.0 - std::sqrt(left)) * axis * axis.transpose();
  return scale * information * scale;
}

}  // namespace

Registration registration(std::span<const Point2> points_in_moving, const NearestSurface& reference,
                          const Pose2& initial, const PoseBelief& prior, const RegistrationParams& params) {
  Registration result;
  result.reference_from_moving = initial;
  double reach_m = params.first_reach_m;
  for (int i = 0; i < params.most_iterations; ++i) {
    const PairSums sums = sums_over_pairs(points_in_moving, reference, result.reference_from_moving, reach_m);
    if (sums.paired < 3) return result;
    const double mean_square = sums.squares / static_cast<double>(sums.paired);
    const double variance = std::max(params.point_deviation_m * params.point_deviation_m, mean_square);
    result.information = sums.matrix / variance;
    result.deviation_m = std::sqrt(mean_square);
    result.paired = sums.paired;

    const Eigen::Vector3d from_prior = difference(result.reference_from_moving, prior.pose);
    const Eigen::Matrix3d damping = kDamping * result.information.trace() * Eigen::Matrix3d::Identity();
    const Eigen::Matrix3d matrix = result.information + prior.information + damping;
    const double calm = 2 * i < params.most_iterations ? 1.0 : 0.5;  // breaks cycles of pairs that come and go
    const Eigen::Vector3d step =
        calm * matrix.ldlt().solve(sums.right_side / variance + prior.information * from_prior);
    Pose2& pose = result.reference_from_moving;
    pose = {pose.x + step.x(), pose.y + step.y(), wrapped_angle(pose.theta + step.z())};
    const bool at_last_reach = reach_m <= params.last_reach_m;
    const double most2 = params.settled_deviations * params.settled_deviations;
    if (at_last_reach && (step.cwiseAbs().maxCoeff() < params.settled_m || step.dot(matrix * step) < most2)) {
      result.settled = true;
      break;
    }
    reach_m = std::max(params.last_reach_m, reach_m * kReachShrink);
  }
  result.information = without_normal_noise(result.information);
  return result;
}

}  // namespace deltamap::mapping::registration
