// SPDX-License-Identifier: Apache-2.0
#include "localization/odometer/laser_odometer.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>

#include "core/geometry/pose_spread.hpp"

namespace deltamap::localization::odometer {
namespace {

constexpr double kInsertM = 0.15;
constexpr double kInsertRad = 0.14;
constexpr int kInsertStanding = 3;  // times, where the robot comes to stand
constexpr double kWayPerRad = 0.3;  // turning makes the view as different as so many metres

constexpr double kTrustInWheels = 0.03;  // of score, over other starts
constexpr double kMoreInliers = 0.08;    // of a fit that lies far from what the wheels say
constexpr double kFewInliers = 0.45;
constexpr double kFewerInliers = 0.7;  // of the usual share
constexpr double kFoundInliers = 0.12;
constexpr double kLostInliers = 0.25;
constexpr std::size_t kFewestLines = 20;
constexpr double kNewest = 0.05;  // share of one scan in the usual inliers
constexpr double kUnknown = 1e4;
// A robot can be stopped at once, but not be moved on so far beyond what its wheels turn: then the scene has changed.
constexpr double kShovedM = 0.05;
constexpr double kShoved_m_per_s2 = 3.0;

constexpr double kStands = 20.0;     // nats
constexpr double kTurningM = 0.002;  // from scan to scan: wheels that turn
constexpr double kAnchorM = 1.0;     // claimed since a scan that others are held against: then another is taken

constexpr double kDisagree = 25.0;  // squared deviations
constexpr std::array kWindowsS{0.6, 1.5};

/// What wheels may be off in a motion, along it, across it and in its heading: variances.
struct WheelNoise {
  double floor_m, along, across, metre_per_rad_along, metre_per_rad_across;
  double floor_rad, rad_per_rad, rad_per_metre;

  [[nodiscard]] PoseCovariance of(double driven_m, double turned_rad) const {
    const double x = floor_m + along * driven_m + metre_per_rad_along * turned_rad;
    const double y = floor_m + across * driven_m + metre_per_rad_across * turned_rad;
    const double t = floor_rad + rad_per_rad * turned_rad + rad_per_metre * driven_m;
    return Eigen::Vector3d{x * x, y * y, t * t}.asDiagonal();
  }
};
// What the wheels count in the fusion; what makes an alarm; how weakly they hold the registration.
constexpr WheelNoise kFused{0.005, 0.08, 0.04, 0.02, 0.05, 0.004, 0.15, 0.05};
constexpr WheelNoise kUsual{0.005, 0.04, 0.02, 0.01, 0.02, 0.004, 0.06, 0.02};
constexpr WheelNoise kLoose{0.05, 0.3, 0.15, 0.0, 0.0, 0.03, 0.2, 0.05};
constexpr double kLooseShare = 0.3;

PoseCovariance turned(const PoseCovariance& covariance, double by_rad) {
  Eigen::Matrix3d rotation = Eigen::Matrix3d::Identity();
  rotation.topLeftCorner<2, 2>() << std::cos(by_rad), -std::sin(by_rad), std::sin(by_rad), std::cos(by_rad);
  return rotation * covariance * rotation.transpose();
}

/// A pose's covariance after a motion that leads it from here to there.
PoseCovariance carried(const PoseCovariance& covariance, const Pose2& from, const Pose2& to) {
  Eigen::Matrix3d by_start = Eigen::Matrix3d::Identity();
  by_start(0, 2) = from.y - to.y;
  by_start(1, 2) = to.x - from.x;
  return by_start * covariance * by_start.transpose();
}

bool is_a_drive(const Pose2& motion, double passed_s) {
  return motion.position().norm() <= 2.0 * std::min(passed_s + 1.0, 3.0) + 0.1 &&
         std::abs(motion.theta) <= 3.5 * (passed_s + 1.0);
}

Pose2 stretched(const Pose2& motion, double factor) {
  return {factor * motion.x, factor * motion.y, wrapped_angle(factor * motion.theta)};
}

}  // namespace

std::optional<Pose2> LaserOdometer::searched(std::span<const LinePoint> points, const Pose2& around,
                                             double inliers) const {
  constexpr double kTurnsRad = 1.2;
  constexpr double kTurnRad = 0.05;
  constexpr double kShiftsM = 0.9;
  constexpr double kShiftM = 0.3;
  constexpr double kPerUnit = 0.15;  // of score that a metre or radian costs
  Pose2 best = around;
  double best_score = score(map_, points, around);
  const auto look = [&](const Pose2& pose) {
    const double cost = kPerUnit * (distance_between(around, pose) + std::abs(turn_between(around.theta, pose.theta)));
    const double found = score(map_, points, pose) - cost;
    if (found <= best_score) return;
    best_score = found;
    best = pose;
  };
  for (double turn = -kTurnsRad; turn <= kTurnsRad; turn += kTurnRad)
    look({around.x, around.y, wrapped_angle(around.theta + turn)});
  const Pose2 turned_best = best;
  for (double x = -kShiftsM; x <= kShiftsM + 1e-9; x += kShiftM) {
    for (double y = -kShiftsM; y <= kShiftsM + 1e-9; y += kShiftM)
      look({turned_best.x + x, turned_best.y + y, turned_best.theta});
  }
  const Pose2 found = registered(map_, points, best, 0.3, {best});
  if (inlier_share(map_, points, found) < inliers + kFoundInliers) return std::nullopt;
  return found;
}

ScanFit LaserOdometer::fit(std::span<const LinePoint> points, const Pose2& by_wheels, double driven_m,
                           double turned_rad) const {
  const FitPrior prior{by_wheels, kLooseShare * turned(kLoose.of(driven_m, turned_rad), pose_.theta).inverse()};
  const std::array starts{by_wheels, pose_, pose_ * last_motion_};
  std::size_t best = 0;
  double best_score = 0.0;
  for (std::size_t i = 0; i < starts.size(); ++i) {
    const double here = score(map_, points, starts[i]) + (i == 0 ? kTrustInWheels : 0.0);
    if (here <= best_score) continue;
    best_score = here;
    best = i;
  }
  const double start_off_m = best_score > 0.9 ? 0.02 : best_score > 0.75 ? 0.033 : 0.1;
  Pose2 found = registered(map_, points, starts[best], start_off_m, prior);
  if (best != 0 && distance_between(found, by_wheels) > 0.05 + 0.1 * driven_m) {
    const Pose2 from_wheels = registered(map_, points, by_wheels, 0.1, prior);
    const bool is_clear = inlier_share(map_, points, found) >= inlier_share(map_, points, from_wheels) + kMoreInliers;
    if (!is_clear) found = from_wheels;
  }
  ScanFit fitted = judged(map_, points, found);
  if (fitted.lines >= kFewestLines &&
      (fitted.inliers < kFewInliers || fitted.inliers < kFewerInliers * usual_inliers_)) {
    if (const std::optional<Pose2> elsewhere = searched(points, by_wheels, fitted.inliers))
      fitted = judged(map_, points, *elsewhere);
  }
  return fitted;
}

/// From here on the wheels go on from where the robot is.
void LaserOdometer::slipped(const Pose2& slip, LaserMotion& answer) {
  answer.slip = slip;
  last_wheels_->odom_from_robot = last_wheels_->odom_from_robot * slip;
  compared_.clear();
}

LaserMotion LaserOdometer::observe(const Scan& scan, std::span<const RayInRobot> rays,
                                   const std::optional<WheelsAt>& wheels) {
  const std::span<const LinePoint> points = finder_.points_of(scan, rays);
  LaserMotion answer;
  if (!last_ || scan.time < *last_) {
    *this = LaserOdometer{};
    const std::span<const LinePoint> first = finder_.points_of(scan, rays);
    last_ = scan.time;
    last_wheels_ = wheels;
    map_.insert(first, pose_);
    return answer;
  }
  const double passed_s = seconds(scan.time - *last_);
  last_ = scan.time;
  last_motion_ = stretched(last_motion_, last_step_s_ > 0.0 ? std::min(2.0, passed_s / last_step_s_) : 0.0);
  last_step_s_ = passed_s;
  bool by_wheels = wheels && last_wheels_ && wheels->epoch == last_wheels_->epoch;
  Pose2 counted;
  if (by_wheels) {
    counted = motion_between(last_wheels_->odom_from_robot, wheels->odom_from_robot);
    by_wheels = is_a_drive(counted, passed_s);
  }
  if (!by_wheels) {
    counted = last_motion_;
    compared_.clear();
  }
  last_wheels_ = wheels;
  const double driven_m = counted.position().norm();
  const double turned_rad = std::abs(counted.theta);
  time_s_ += passed_s;
  way_m_ += driven_m + kWayPerRad * turned_rad;
  map_.go_on(way_m_, time_s_);
  const Pose2 before_wheels = wheels_;
  wheels_ = wheels_ * counted;

  anchor_.claimed = anchor_.claimed * counted;
  const bool is_claimed =
      by_wheels && (anchor_.claimed.position().norm() > 0.01 || std::abs(anchor_.claimed.theta) > 0.01);
  const bool is_same = is_claimed && standstill_.is_same(scan);
  const double odds = is_same ? standstill_.log_odds(scan, rays, anchor_.claimed) : Standstill::kClearlyMoved;
  const double claimed_m = anchor_.claimed.position().norm();
  stands_ = odds > kStands || (stands_ && odds > Standstill::kClearlyMoved && claimed_m < kAnchorM);
  const double claimed_now_m = driven_m + kWayPerRad * turned_rad;
  stood_m_ = stands_ && claimed_now_m > kTurningM ? stood_m_ + claimed_now_m : 0.0;
  if (stands_) {
    answer.motion = motion_between(pose_, anchor_.start_from_robot);
    answer.by_laser = answer.motion;
    answer.contradicts = true;
    answer.stood_m = stood_m_;
    answer.inliers = 1.0;
    pose_ = anchor_.start_from_robot;
    deviation_ = anchor_.deviation;
    last_motion_ = {};
    map_.forget_since(anchor_.time_s);
    slipped(inverse(counted) * answer.motion, answer);
    distrusted_until_s_ = time_s_ + kWindowsS.back();
    if (odds > kStands && claimed_m > 0.5 * kAnchorM) {
      standstill_.keep(scan, rays);
      anchor_ = {pose_, deviation_, time_s_, {}};
    }
    return answer;
  }

  const double unknown = 0.1 + 0.5 * passed_s;
  PoseCovariance wheel_noise = turned(kFused.of(driven_m, turned_rad), pose_.theta);
  PoseCovariance usual_noise = turned(kUsual.of(driven_m, turned_rad), pose_.theta);
  if (!by_wheels) {
    wheel_noise += PoseCovariance::Identity() * unknown * unknown;
    usual_noise += PoseCovariance::Identity() * unknown * unknown;
  }
  const Pose2 predicted = pose_ * counted;
  const PoseCovariance before = carried(deviation_, pose_, predicted);

  ScanFit fitted = fit(points, predicted, driven_m, turned_rad);
  const double beyond_wheels_m = distance_between(pose_, fitted.map_from_robot) - driven_m;
  const bool is_lost = fitted.inliers < kLostInliers || fitted.lines < kFewestLines ||
                       (fitted.inliers < 0.4 && fitted.inliers < 0.6 * usual_inliers_) ||
                       (by_wheels && beyond_wheels_m > kShovedM + kShoved_m_per_s2 * passed_s * passed_s);
  if (is_lost) fitted.covariance *= kUnknown;
  lost_in_a_row_ = is_lost ? lost_in_a_row_ + 1 : 0;
  if (!is_lost) usual_inliers_ += (usual_inliers_ == 0.0 ? 1.0 : kNewest) * (fitted.inliers - usual_inliers_);

  const Eigen::Vector3d off = difference(predicted, fitted.map_from_robot);
  answer.disagreement = squared_deviations(off, fitted.covariance + before + usual_noise);
  Compared since{time_s_ - passed_s, {}, pose_, before_wheels};
  if (!is_lost) {
    for (const double window_s : kWindowsS) {
      const auto first = std::find_if(compared_.begin(), compared_.end(),
                                      [&](const Compared& c) { return c.time_s >= time_s_ - window_s - 1e-6; });
      if (first == compared_.end()) continue;
      const Pose2 told = motion_between(first->wheels, wheels_);
      const Pose2 seen = motion_between(first->start_from_laser, fitted.map_from_robot);
      const PoseCovariance expected = turned(2.0 * fitted.covariance, -first->start_from_laser.theta) +
                                      kUsual.of(told.position().norm(), std::abs(told.theta));
      const double disagreement = squared_deviations(difference(told, seen), expected);
      if (disagreement <= answer.disagreement) continue;
      answer.disagreement = disagreement;
      since = *first;
    }
  }
  answer.contradicts = by_wheels && !is_lost && answer.disagreement > kDisagree;
  if (answer.contradicts) {
    wheel_noise += off * off.transpose();
    wheel_noise.topLeftCorner<2, 2>() += 0.09 * driven_m * driven_m * Eigen::Matrix2d::Identity();
  }
  const PoseCovariance unsure = before + wheel_noise;
  const Eigen::Matrix3d gain = unsure * (unsure + fitted.covariance).inverse();
  const Eigen::Vector3d moved = gain * off;
  const Pose2 believed{predicted.x + moved.x(), predicted.y + moved.y(), wrapped_angle(predicted.theta + moved.z())};
  deviation_ = (Eigen::Matrix3d::Identity() - gain) * unsure;
  deviation_ = 0.5 * (deviation_ + deviation_.transpose()).eval();

  answer.motion = motion_between(pose_, believed);
  answer.covariance = turned((Eigen::Matrix3d::Identity() - gain) * wheel_noise, -pose_.theta);
  answer.by_laser = motion_between(pose_, fitted.map_from_robot);
  answer.laser_covariance = turned(fitted.covariance, -pose_.theta);
  answer.is_lost = is_lost;
  answer.inliers = fitted.inliers;
  last_motion_ = answer.motion;
  pose_ = believed;
  if (answer.contradicts) distrusted_until_s_ = time_s_ + kWindowsS.back();
  if (by_wheels && !is_lost && time_s_ <= distrusted_until_s_) {
    const Pose2 told = motion_between(since.wheels, wheels_);
    slipped(motion_between(told, motion_between(since.start_from_robot, pose_)), answer);
  }
  if (!is_lost) {
    compared_.push_back({time_s_, fitted.map_from_robot, pose_, wheels_});
    while (compared_.front().time_s < time_s_ - kWindowsS.back() - 1e-6) compared_.pop_front();
  }

  if ((is_claimed && odds <= Standstill::kClearlyMoved) || claimed_m > kAnchorM || !standstill_.has_kept()) {
    standstill_.keep(scan, rays);
    anchor_ = {pose_, deviation_, time_s_, {}};
  }

  const Pose2 moved_on = motion_between(inserted_at_, pose_);
  const bool has_moved = moved_on.position().norm() > kInsertM || std::abs(moved_on.theta) > kInsertRad;
  const bool stands = answer.motion.position().norm() < 0.01 && std::abs(answer.motion.theta) < 0.01;
  const bool may = !is_lost || lost_in_a_row_ % 3 == 0;
  if (may && (has_moved || (stands && inserted_standing_ < kInsertStanding))) {
    inserted_standing_ = has_moved ? 0 : inserted_standing_ + 1;
    inserted_at_ = pose_;
    map_.insert(points, pose_);
  }
  return answer;
}

}  // namespace deltamap::localization::odometer
