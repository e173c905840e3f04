// SPDX-License-Identifier: Apache-2.0
#include "localization/odometer/scan_fit.hpp"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

namespace deltamap::localization::odometer {
namespace {

constexpr float kNearM = 0.4F;
constexpr float kOnSurfelM = 0.06F;
constexpr double kScoreM = 0.1;
constexpr std::size_t kEachScored = 3;
constexpr float kWithoutLine = 0.3F;  // weight of a point that lies on no line
constexpr float kYoung = 0.15F;       // weight of a surfel that was seen first less than a second ago
constexpr float kLastScaleM = 0.05F;  // of the robust weight
constexpr float kTighter = 0.6F;      // from step to step
constexpr int kMostSteps = 8;
constexpr double kSettledM = 5e-4;
constexpr double kSettledRad = 2e-4;

constexpr double kLeastDeviationM = 0.02;  // of a point from its surfel
constexpr double kSharedErrors = 12.0;     // beams that err alike count as one
constexpr double kNormalRad = 0.12;        // by which normals err
constexpr std::size_t kSectors = 16;
const PoseCovariance kLeastCovariance = Eigen::Vector3d{9e-6, 9e-6, 2.25e-6}.asDiagonal();

/// The points of a scan, seen from a pose.
class Placed {
 public:
  explicit Placed(const Pose2& map_from_robot)
      : pose_{map_from_robot},
        c_{static_cast<float>(std::cos(map_from_robot.theta))},
        s_{static_cast<float>(std::sin(map_from_robot.theta))} {}

  /// From the robot, along the axes of the map.
  [[nodiscard]] Eigen::Vector2f turned(const Eigen::Vector2f& v) const {
    return {c_ * v.x() - s_ * v.y(), s_ * v.x() + c_ * v.y()};
  }
  [[nodiscard]] Point2 at(const Eigen::Vector2f& arm) const {
    return {pose_.x + static_cast<double>(arm.x()), pose_.y + static_cast<double>(arm.y())};
  }

 private:
  Pose2 pose_;
  float c_;
  float s_;
};

float robust_weight(float off_m, float scale_m) {
  const float w = scale_m * scale_m / (scale_m * scale_m + off_m * off_m);
  return w * w;
}

float weight_of(const SurfelMap& map, const LinePoint& point, const Surfel& surfel) {
  return (point.has_line() ? 1.0F : kWithoutLine) * (map.is_young(surfel) ? kYoung : 1.0F);
}

/// Σ w J Jᵀ and Σ w J e; J is (n, n · R(90°) arm).
struct Sums {
  float xx = 0.0F, xy = 0.0F, xt = 0.0F, yy = 0.0F, yt = 0.0F, tt = 0.0F;
  float bx = 0.0F, by = 0.0F, bt = 0.0F;

  void add(const Eigen::Vector2f& normal, const Eigen::Vector2f& arm, float weight, float off_m) {
    const float t = normal.y() * arm.x() - normal.x() * arm.y();
    const float wx = weight * normal.x();
    const float wy = weight * normal.y();
    const float wt = weight * t;
    xx += wx * normal.x(), xy += wx * normal.y(), xt += wx * t, yy += wy * normal.y(), yt += wy * t, tt += wt * t;
    bx += wx * off_m, by += wy * off_m, bt += wt * off_m;
  }
  [[nodiscard]] Eigen::Matrix3d matrix() const {
    Eigen::Matrix3d m;
    m << xx, xy, xt, xy, yy, yt, xt, yt, tt;
    return m;
  }
  [[nodiscard]] Eigen::Vector3d right_side() const { return {bx, by, bt}; }
};

}  // namespace

double score(const SurfelMap& map, std::span<const LinePoint> points, const Pose2& map_from_robot) {
  const Placed placed{map_from_robot};
  double sum = 0.0;
  std::size_t count = 0;
  std::size_t line = 0;
  for (const LinePoint& point : points) {
    if (!point.has_line() || line++ % kEachScored != 0) continue;
    ++count;
    const NearSurfel near = map.near(placed.at(placed.turned(point.at)), placed.turned(point.normal), kNearM);
    if (near.surfel == nullptr) continue;
    const double off = static_cast<double>(near.off_m) / kScoreM;
    sum += 1.0 / (1.0 + off * off);
  }
  return count == 0 ? 0.0 : sum / static_cast<double>(count);
}

double inlier_share(const SurfelMap& map, std::span<const LinePoint> points, const Pose2& map_from_robot) {
  const Placed placed{map_from_robot};
  std::size_t lines = 0;
  std::size_t on = 0;
  for (const LinePoint& point : points) {
    if (!point.has_line()) continue;
    ++lines;
    const NearSurfel near = map.near(placed.at(placed.turned(point.at)), placed.turned(point.normal), kNearM);
    if (near.surfel != nullptr && std::abs(near.off_m) < kOnSurfelM) ++on;
  }
  return lines == 0 ? 0.0 : static_cast<double>(on) / static_cast<double>(lines);
}

Pose2 registered(const SurfelMap& map, std::span<const LinePoint> points, const Pose2& start, double start_off_m,
                 const FitPrior& prior) {
  Pose2 pose = start;
  float scale_m = std::clamp(3.0F * static_cast<float>(start_off_m), 0.06F, 0.3F);
  for (int step = 0; step < kMostSteps; ++step) {
    const Placed placed{pose};
    Sums sums;
    for (const LinePoint& point : points) {
      const Eigen::Vector2f arm = placed.turned(point.at);
      const NearSurfel near = map.near(placed.at(arm), placed.turned(point.normal), kNearM);
      if (near.surfel == nullptr) continue;
      sums.add(near.surfel->normal, arm, weight_of(map, point, *near.surfel) * robust_weight(near.off_m, scale_m),
               near.off_m);
    }
    constexpr double kPerPoint_m2 = 1.0 / (kLeastDeviationM * kLeastDeviationM * kSharedErrors);
    const Eigen::Matrix3d matrix = kPerPoint_m2 * sums.matrix() + prior.information;
    const Eigen::Vector3d right =
        -kPerPoint_m2 * sums.right_side() + prior.information * difference(pose, prior.map_from_robot);
    const Eigen::Vector3d move = matrix.ldlt().solve(right);
    if (!move.allFinite()) return start;
    pose = {pose.x + move.x(), pose.y + move.y(), wrapped_angle(pose.theta + move.z())};
    const bool is_settled = move.head<2>().norm() < kSettledM && std::abs(move.z()) < kSettledRad;
    if (is_settled && scale_m <= kLastScaleM) break;
    scale_m = std::max(kLastScaleM, is_settled ? kLastScaleM : scale_m * kTighter);
  }
  return pose;
}

ScanFit judged(const SurfelMap& map, std::span<const LinePoint> points, const Pose2& map_from_robot) {
  ScanFit fit{.map_from_robot = map_from_robot};
  const Placed placed{map_from_robot};
  std::array<Sums, kSectors> by_sector{};  // of the view, so that what one person supports can be told
  Sums tangents;
  double weights = 0.0;
  double squares_m2 = 0.0;
  std::size_t on = 0;
  for (const LinePoint& point : points) {
    const Eigen::Vector2f arm = placed.turned(point.at);
    if (point.has_line()) ++fit.lines;
    const NearSurfel near = map.near(placed.at(arm), placed.turned(point.normal), kNearM);
    if (near.surfel == nullptr) continue;
    if (point.has_line() && std::abs(near.off_m) < kOnSurfelM) ++on;
    const float weight = weight_of(map, point, *near.surfel) * robust_weight(near.off_m, kLastScaleM);
    const Eigen::Vector2f& normal = near.surfel->normal;
    const double bearing = std::atan2(point.at.y(), point.at.x()) / (2.0 * std::numbers::pi) + 0.5;
    const std::size_t sector = static_cast<std::size_t>(bearing * static_cast<double>(kSectors)) % kSectors;
    by_sector[sector].add(normal, arm, weight, 0.0F);
    tangents.add({-normal.y(), normal.x()}, arm, weight, 0.0F);
    weights += static_cast<double>(weight);
    squares_m2 += static_cast<double>(weight * near.off_m * near.off_m);
  }
  fit.inliers = fit.lines == 0 ? 0.0 : static_cast<double>(on) / static_cast<double>(fit.lines);
  const double deviation2 =
      kSharedErrors * std::max(kLeastDeviationM * kLeastDeviationM, weights > 0.0 ? squares_m2 / weights : 0.0);
  std::array<Eigen::Matrix3d, kSectors> shares;
  Eigen::Matrix3d information = -kNormalRad * kNormalRad / deviation2 * tangents.matrix();
  for (std::size_t i = 0; i < kSectors; ++i) {
    shares[i] = by_sector[i].matrix() / deviation2;
    information += shares[i];
  }
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> axes{information};
  Eigen::Vector3d known = axes.eigenvalues().cwiseMax(0.0);
  for (Eigen::Index axis = 0; axis < 2; ++axis) {
    const Eigen::Vector3d v = axes.eigenvectors().col(axis);
    double most = 0.0;
    for (std::size_t i = 0; i < kSectors; ++i)
      most = std::max(most, v.dot((shares[i] + shares[(i + 1) % kSectors]) * v));
    known[axis] = std::max(0.0, known[axis] - most);
  }
  constexpr double kNothingKnown = 1e-3;
  const Eigen::Vector3d variances = (known.array() + kNothingKnown).inverse();
  fit.covariance = axes.eigenvectors() * variances.asDiagonal() * axes.eigenvectors().transpose() + kLeastCovariance;
  return fit;
}

}  // namespace deltamap::localization::odometer
