// SPDX-License-Identifier: Apache-2.0
#include "localization/odometer/scan_fit.hpp"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <algorithm>
#include <array>
#include <cmath>

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
// The surfels near the points at one pose are those near them at another so close by.
constexpr double kMatchedM = 0.03;
constexpr double kMatchedRad = 0.01;

constexpr double kLeastDeviationM = 0.02;  // of a point from its surfel
constexpr double kSharedErrors = 12.0;     // beams that err alike count as one
constexpr double kNormalRad = 0.12;        // by which normals err
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
  /// How far a point lies from a surfel, along its normal.
  [[nodiscard]] float off_m(const Eigen::Vector2f& arm, const Point2& surfel_at, const Eigen::Vector2f& normal) const {
    const Eigen::Vector2f between = (at(arm) - surfel_at).cast<float>();
    return normal.dot(between);
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

/// What noise of the normals alone would tell is taken away, and of the two weaker axes what the strongest two
/// neighbouring sectors tell. `deviation2`: of a point from its surfel, m².
PoseCovariance covariance_of(const std::array<Sums, kSectors>& by_sector, const Sums& tangents, double deviation2) {
  constexpr double kNothingKnown = 1e-3;
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
    for (std::size_t i = 0; i + 1 < kSectors; ++i) most = std::max(most, v.dot((shares[i] + shares[i + 1]) * v));
    known[axis] = std::max(0.0, known[axis] - most);
  }
  const Eigen::Vector3d variances = (known.array() + kNothingKnown).inverse();
  return axes.eigenvectors() * variances.asDiagonal() * axes.eigenvectors().transpose() + kLeastCovariance;
}

}  // namespace

ScanFitter::ScanFitter(const SurfelMap& map, std::span<const LinePoint> points)
    : map_{map},
      points_{points},
      lines_{static_cast<std::size_t>(
          std::count_if(points.begin(), points.end(), [](const LinePoint& p) { return p.has_line(); }))} {}

double ScanFitter::score(const Pose2& map_from_robot) const {
  const Placed placed{map_from_robot};
  double sum = 0.0;
  std::size_t count = 0;
  std::size_t line = 0;
  for (const LinePoint& point : points_) {
    if (!point.has_line() || line++ % kEachScored != 0) continue;
    ++count;
    const NearSurfel near = map_.near(placed.at(placed.turned(point.at)), placed.turned(point.normal), kNearM);
    if (near.surfel == nullptr) continue;
    const double off = static_cast<double>(near.off_m) / kScoreM;
    sum += 1.0 / (1.0 + off * off);
  }
  return count == 0 ? 0.0 : sum / static_cast<double>(count);
}

void ScanFitter::match(const Pose2& map_from_robot) {
  const bool is_close = has_matched_ && distance_between(matched_at_, map_from_robot) < kMatchedM &&
                        std::abs(turn_between(matched_at_.theta, map_from_robot.theta)) < kMatchedRad;
  if (is_close) return;
  has_matched_ = true;
  matched_at_ = map_from_robot;
  matches_.clear();
  const Placed placed{map_from_robot};
  for (const LinePoint& point : points_) {
    const Point2 at = placed.at(placed.turned(point.at));
    const NearSurfel near = map_.near(at, placed.turned(point.normal), kNearM);
    if (near.surfel == nullptr) continue;
    const float weight = (point.has_line() ? 1.0F : kWithoutLine) * (map_.is_young(*near.surfel) ? kYoung : 1.0F);
    const Eigen::Vector2f& normal = near.surfel->normal;
    matches_.push_back({&point, at - static_cast<double>(near.off_m) * normal.cast<double>(), normal, weight});
  }
}

double ScanFitter::inlier_share(const Pose2& map_from_robot) {
  match(map_from_robot);
  const Placed placed{map_from_robot};
  const auto on = std::count_if(matches_.begin(), matches_.end(), [&](const Match& match) {
    return match.point->has_line() &&
           std::abs(placed.off_m(placed.turned(match.point->at), match.at, match.normal)) < kOnSurfelM;
  });
  return lines_ == 0 ? 0.0 : static_cast<double>(on) / static_cast<double>(lines_);
}

Pose2 ScanFitter::registered(const Pose2& start, double start_off_m, const FitPrior& prior) {
  constexpr double kPerPoint_m2 = 1.0 / (kLeastDeviationM * kLeastDeviationM * kSharedErrors);
  Pose2 pose = start;
  float scale_m = std::clamp(3.0F * static_cast<float>(start_off_m), 0.06F, 0.3F);
  for (int step = 0; step < kMostSteps; ++step) {
    match(pose);
    const Placed placed{pose};
    Sums sums;
    for (const Match& match : matches_) {
      const Eigen::Vector2f arm = placed.turned(match.point->at);
      const float off_m = placed.off_m(arm, match.at, match.normal);
      sums.add(match.normal, arm, match.weight * robust_weight(off_m, scale_m), off_m);
    }
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

ScanFit ScanFitter::judged(const Pose2& map_from_robot) {
  ScanFit fit{.map_from_robot = map_from_robot};
  fit.inliers = inlier_share(map_from_robot);
  fit.lines = lines_;
  const Placed placed{map_from_robot};
  std::array<Sums, kSectors> by_sector{};  // so that what one person supports can be told
  Sums tangents;
  float weights = 0.0F;
  float squares_m2 = 0.0F;
  for (const Match& match : matches_) {
    const Eigen::Vector2f arm = placed.turned(match.point->at);
    const float off_m = placed.off_m(arm, match.at, match.normal);
    const float weight = match.weight * robust_weight(off_m, kLastScaleM);
    by_sector[match.point->sector].add(match.normal, arm, weight, 0.0F);
    tangents.add({-match.normal.y(), match.normal.x()}, arm, weight, 0.0F);
    weights += weight;
    squares_m2 += weight * off_m * off_m;
  }
  const double mean_m2 = weights > 0.0F ? static_cast<double>(squares_m2 / weights) : 0.0;
  fit.covariance =
      covariance_of(by_sector, tangents, kSharedErrors * std::max(kLeastDeviationM * kLeastDeviationM, mean_m2));
  return fit;
}

}  // namespace deltamap::localization::odometer
