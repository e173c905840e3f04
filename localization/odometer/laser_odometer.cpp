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
constexpr double kPoorInliers = 0.4;
constexpr double kPoorerInliers = 0.6;  // of the usual share
constexpr double kGoodScore = 0.9;      // of a start
constexpr double kFairScore = 0.75;
constexpr std::size_t kFewestLines = 20;
constexpr double kNewest = 0.05;  // share of one scan in the usual inliers
constexpr double kUnknown = 1e4;
// A robot can be stopped at once, but not be moved on so far beyond what its wheels turn: then the scene has changed.
constexpr double kShovedM = 0.05;
constexpr double kShoved_m_per_s2 = 3.0;

constexpr double kSameTimeS = 1e-6;
constexpr double kClaimedM = 0.01;  // by the wheels, since a scan: less tells nothing
constexpr double kClaimedRad = 0.01;
constexpr double kStands = 12.0;     // nats: on real logs no robot that drives has reached one
constexpr double kTurningM = 0.002;  // from scan to scan: wheels that turn
constexpr double kAnchorM = 0.4;     // claimed since a scan that others are held against: then another is taken
constexpr double kTellsMore = 2.0;   // nats: then that goes on with what the scans before it have told,
constexpr double kMostTold = 30.0;   // of which no more is kept

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

Eigen::Matrix3d rotation(double by_rad) {
  Eigen::Matrix3d rotation = Eigen::Matrix3d::Identity();
  rotation.topLeftCorner<2, 2>() << std::cos(by_rad), -std::sin(by_rad), std::sin(by_rad), std::cos(by_rad);
  return rotation;
}

PoseCovariance turned(const PoseCovariance& covariance, double by_rad) {
  return rotation(by_rad) * covariance * rotation(-by_rad);
}

bool is_a_drive(const Pose2& motion, double passed_s) {
  return motion.position().norm() <= 2.0 * std::min(passed_s + 1.0, 3.0) + 0.1 &&
         std::abs(motion.theta) <= 3.5 * (passed_s + 1.0);
}

Pose2 stretched(const Pose2& motion, double factor) {
  return {factor * motion.x, factor * motion.y, wrapped_angle(factor * motion.theta)};
}

/// Far around the pose that the wheels tell: nothing where the scan fits no better elsewhere.
std::optional<Pose2> searched(ScanFitter& fitter, const Pose2& around, double inliers) {
  constexpr double kTurnRad = 0.05;
  constexpr int kTurns = 24;  // to either side
  constexpr double kShiftM = 0.3;
  constexpr int kShifts = 3;         // to either side
  constexpr double kPerUnit = 0.15;  // of score that a metre or radian costs
  Pose2 best = around;
  double best_score = fitter.score(around);
  const auto look = [&](const Pose2& pose) {
    const double cost = kPerUnit * (distance_between(around, pose) + std::abs(turn_between(around.theta, pose.theta)));
    const double found = fitter.score(pose) - cost;
    if (found <= best_score) return;
    best_score = found;
    best = pose;
  };
  for (int turn = -kTurns; turn <= kTurns; ++turn)
    look({around.x, around.y, wrapped_angle(around.theta + turn * kTurnRad)});
  const Pose2 turned_best = best;
  for (int x = -kShifts; x <= kShifts; ++x) {
    for (int y = -kShifts; y <= kShifts; ++y)
      look({turned_best.x + x * kShiftM, turned_best.y + y * kShiftM, turned_best.theta});
  }
  const Pose2 found = fitter.registered(best, 0.3, {best});
  if (fitter.inlier_share(found) < inliers + kFoundInliers) return std::nullopt;
  return found;
}

}  // namespace

double LaserOdometer::Step::way_m() const { return driven_m + kWayPerRad * turned_rad; }

LaserMotion LaserOdometer::observe(const Scan& scan, std::span<const RayInRobot> rays,
                                   const std::optional<WheelsAt>& wheels, bool leads) {
  LaserMotion answer;
  if (last_ && scan.time < *last_) *this = LaserOdometer{};
  const std::span<const LinePoint> points = finder_.points_of(scan, rays);
  if (!last_) {
    last_ = scan.time;
    last_wheels_ = wheels;
    map_.insert(points, pose_);
    return answer;
  }
  const Step step = step_to(scan.time, wheels);
  if (stands_still(scan, rays, step)) {
    stand(answer, step);
    const bool is_clear = odds_of_standing() > kStands && anchor_.claimed.position().norm() > 0.5 * kAnchorM;
    if (is_clear) go_on_standing(scan, rays);
    return answer;
  }
  const Pose2 predicted = pose_ * step.motion;
  ScanFit fitted = fit(points, predicted, step);
  answer.inliers = fitted.inliers;
  answer.is_lost = fits_nowhere(fitted, step);
  if (answer.is_lost) fitted.covariance *= kUnknown;
  lost_in_a_row_ = answer.is_lost ? lost_in_a_row_ + 1 : 0;
  if (!answer.is_lost) usual_inliers_ += (usual_inliers_ == 0.0 ? 1.0 : kNewest) * (fitted.inliers - usual_inliers_);
  believe(fitted, step, answer);
  if (leads && step.by_wheels && !answer.slip && !answer.is_lost) lead(step, answer);
  const bool has_moved = standing_odds_ <= Standstill::kClearlyMoved && anchor_.claimed != Pose2{};
  const bool is_far = anchor_.claimed.position().norm() > kAnchorM;
  if (is_far && standing_odds_ > kTellsMore) {
    go_on_standing(scan, rays);
  } else if (is_far || has_moved || !standstill_.has_kept()) {
    anchor(scan, rays);
  }
  remember(points, answer);
  return answer;
}

LaserOdometer::Step LaserOdometer::step_to(Timestamp time, const std::optional<WheelsAt>& wheels) {
  Step step;
  step.passed_s = seconds(time - *last_);
  last_ = time;
  last_motion_ = stretched(last_motion_, last_step_s_ > 0.0 ? std::min(2.0, step.passed_s / last_step_s_) : 0.0);
  last_step_s_ = step.passed_s;
  if (wheels && last_wheels_ && wheels->epoch == last_wheels_->epoch) {
    step.motion = motion_between(last_wheels_->odom_from_robot, wheels->odom_from_robot);
    step.by_wheels = is_a_drive(step.motion, step.passed_s);
  }
  if (!step.by_wheels) {
    step.motion = last_motion_;
    compared_.clear();
  }
  last_wheels_ = wheels;
  step.driven_m = step.motion.position().norm();
  step.turned_rad = std::abs(step.motion.theta);
  time_s_ += step.passed_s;
  way_m_ += step.way_m();
  map_.go_on(way_m_, time_s_);
  wheels_ = wheels_ * step.motion;
  anchor_.claimed = anchor_.claimed * step.motion;
  return step;
}

bool LaserOdometer::stands_still(const Scan& scan, std::span<const RayInRobot> rays, const Step& step) {
  const double claimed_m = anchor_.claimed.position().norm();
  const bool is_claimed = step.by_wheels && (claimed_m > kClaimedM || std::abs(anchor_.claimed.theta) > kClaimedRad);
  if (!is_claimed) {
    standing_odds_ = 0.0;  // nothing to tell
  } else if (standstill_.is_same(scan)) {
    // Where nothing has spoken for standing yet, odds that would not go on telling are as good as none.
    const bool told = stands_ || anchor_.odds > 0.0;
    standing_odds_ = standstill_.log_odds(scan, rays, anchor_.claimed, told ? Standstill::kClearlyMoved : kTellsMore);
  } else {
    standing_odds_ = Standstill::kClearlyMoved;
  }
  // Once it is clear, it stands as long as nothing speaks for a motion; without any more sign the wheels rule again.
  stands_ = standing_odds_ > Standstill::kClearlyMoved && is_claimed &&
            (odds_of_standing() > kStands || (stands_ && claimed_m < kAnchorM));
  stood_m_ = stands_ && step.way_m() > kTurningM ? stood_m_ + step.way_m() : 0.0;
  return stands_;
}

void LaserOdometer::stand(LaserMotion& answer, const Step& step) {
  answer.motion = answer.by_laser = motion_between(pose_, anchor_.start_from_robot);
  answer.contradicts = true;
  answer.stood_m = stood_m_;
  answer.inliers = 1.0;
  pose_ = anchor_.start_from_robot;
  deviation_ = anchor_.deviation;
  answer.deviation = turned(deviation_, -pose_.theta);
  last_motion_ = {};
  map_.forget_since(anchor_.time_s);
  distrusted_until_s_ = time_s_ + kWindowsS.back();
  correct_wheels(inverse(step.motion) * answer.motion, answer);
}

void LaserOdometer::anchor(const Scan& scan, std::span<const RayInRobot> rays) {
  standstill_.keep(scan, rays);
  anchor_ = {pose_, deviation_, time_s_, {}};
}

/// The robot may still stand where it was at the anchor; only the kept scan is another one. What several scans tell a
/// little of, in a corridor say, adds up.
void LaserOdometer::go_on_standing(const Scan& scan, std::span<const RayInRobot> rays) {
  standstill_.keep(scan, rays);
  anchor_.claimed = {};
  anchor_.odds = std::min(odds_of_standing(), kMostTold);
}

ScanFit LaserOdometer::fit(std::span<const LinePoint> points, const Pose2& predicted, const Step& step) const {
  ScanFitter fitter{map_, points};
  const FitPrior prior{predicted,
                       kLooseShare * turned(kLoose.of(step.driven_m, step.turned_rad), pose_.theta).inverse()};
  Pose2 start = predicted;
  double best_score = fitter.score(predicted) + kTrustInWheels;
  for (const Pose2& other : {pose_, pose_ * last_motion_}) {
    const double here = best_score > kGoodScore ? 0.0 : fitter.score(other);
    if (here <= best_score) continue;
    best_score = here;
    start = other;
  }
  const double start_off_m = best_score > kGoodScore ? 0.02 : best_score > kFairScore ? 0.033 : 0.1;
  Pose2 found = fitter.registered(start, start_off_m, prior);
  if (start != predicted && distance_between(found, predicted) > 0.05 + 0.1 * step.driven_m) {
    const double inliers = fitter.inlier_share(found);
    const Pose2 from_wheels = fitter.registered(predicted, 0.1, prior);
    if (inliers < fitter.inlier_share(from_wheels) + kMoreInliers) found = from_wheels;
  }
  ScanFit fitted = fitter.judged(found);
  const bool fits_badly = fitted.inliers < kFewInliers || fitted.inliers < kFewerInliers * usual_inliers_;
  if (fitted.lines < kFewestLines || !fits_badly) return fitted;
  const std::optional<Pose2> elsewhere = searched(fitter, predicted, fitted.inliers);
  return elsewhere ? fitter.judged(*elsewhere) : fitted;
}

bool LaserOdometer::fits_nowhere(const ScanFit& fitted, const Step& step) const {
  const double beyond_wheels_m = distance_between(pose_, fitted.map_from_robot) - step.driven_m;
  const bool has_leapt =
      step.by_wheels && beyond_wheels_m > kShovedM + kShoved_m_per_s2 * step.passed_s * step.passed_s;
  return has_leapt || fitted.lines < kFewestLines || fitted.inliers < kLostInliers ||
         (fitted.inliers < kPoorInliers && fitted.inliers < kPoorerInliers * usual_inliers_);
}

/// Wheels against scans, over this step and over the last 0.6 and 1.5 s. Answers from where on they disagree most.
LaserOdometer::Compared LaserOdometer::compare(const ScanFit& fitted, const Step& step, LaserMotion& answer) const {
  const Pose2 predicted = pose_ * step.motion;
  const PoseCovariance usual = turned(kUsual.of(step.driven_m, step.turned_rad), pose_.theta);
  answer.disagreement = squared_deviations(difference(predicted, fitted.map_from_robot),
                                           fitted.covariance + carried(deviation_, pose_, predicted) + usual);
  Compared since{time_s_ - step.passed_s, {}, pose_, wheels_ * inverse(step.motion)};
  for (const double window_s : kWindowsS) {
    const auto first = std::find_if(compared_.begin(), compared_.end(),
                                    [&](const Compared& c) { return c.time_s >= time_s_ - window_s - kSameTimeS; });
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
  return since;
}

/// Fuses what the wheels have predicted with the scan.
void LaserOdometer::believe(const ScanFit& fitted, const Step& step, LaserMotion& answer) {
  const Pose2 predicted = pose_ * step.motion;
  const Eigen::Vector3d off = difference(predicted, fitted.map_from_robot);
  const double unknown = step.by_wheels ? 0.0 : 0.1 + 0.5 * step.passed_s;  // m and rad
  PoseCovariance wheel_noise =
      turned(kFused.of(step.driven_m, step.turned_rad), pose_.theta) + unknown * unknown * PoseCovariance::Identity();
  Compared since;
  if (step.by_wheels && !answer.is_lost) {
    since = compare(fitted, step, answer);
    answer.contradicts = answer.disagreement > kDisagree;
  }
  if (answer.contradicts) {
    wheel_noise += off * off.transpose();
    wheel_noise.topLeftCorner<2, 2>() += 0.09 * step.driven_m * step.driven_m * Eigen::Matrix2d::Identity();
    distrusted_until_s_ = time_s_ + kWindowsS.back();
  }
  const PoseCovariance unsure = carried(deviation_, pose_, predicted) + wheel_noise;
  const Eigen::Matrix3d gain = unsure * (unsure + fitted.covariance).inverse();
  const Eigen::Matrix3d kept = Eigen::Matrix3d::Identity() - gain;
  const Eigen::Vector3d moved = gain * off;
  const Pose2 believed{predicted.x + moved.x(), predicted.y + moved.y(), wrapped_angle(predicted.theta + moved.z())};
  deviation_ = kept * unsure;
  deviation_ = 0.5 * (deviation_ + deviation_.transpose()).eval();
  answer.motion = last_motion_ = motion_between(pose_, believed);
  answer.covariance = turned(kept * wheel_noise, -pose_.theta);
  answer.by_laser = motion_between(pose_, fitted.map_from_robot);
  answer.laser_covariance = turned(fitted.covariance, -pose_.theta);
  answer.deviation = turned(deviation_, -believed.theta);
  answer.kept = rotation(-believed.theta) * kept * carrying(pose_, predicted) * rotation(pose_.theta);
  pose_ = believed;
  if (answer.is_lost) return;
  if (step.by_wheels && time_s_ <= distrusted_until_s_) {
    const Pose2 told = motion_between(since.wheels, wheels_);
    correct_wheels(motion_between(told, motion_between(since.start_from_robot, pose_)), answer);
  }
  compared_.push_back({time_s_, fitted.map_from_robot, pose_, wheels_});
  while (compared_.front().time_s < time_s_ - kWindowsS.back() - kSameTimeS) compared_.pop_front();
}

/// From here on the wheels go on from where the robot is.
void LaserOdometer::correct_wheels(const Pose2& slip, LaserMotion& answer) {
  answer.slip = slip;
  last_wheels_->odom_from_robot = last_wheels_->odom_from_robot * slip;
  compared_.clear();
}

/// The wheels go on from where the robot is, though nothing has contradicted them.
void LaserOdometer::lead(const Step& step, LaserMotion& answer) {
  answer.slip = motion_between(step.motion, answer.motion);
  last_wheels_->odom_from_robot = last_wheels_->odom_from_robot * *answer.slip;
  wheels_ = wheels_ * *answer.slip;
  compared_.back().wheels = wheels_;
}

/// Never while it is lost, or a building is bent, but for each third scan: the scene itself may have changed.
void LaserOdometer::remember(std::span<const LinePoint> points, const LaserMotion& answer) {
  const Pose2 moved = motion_between(inserted_at_, pose_);
  const bool has_moved = moved.position().norm() > kInsertM || std::abs(moved.theta) > kInsertRad;
  const bool stands = answer.motion.position().norm() < 0.01 && std::abs(answer.motion.theta) < 0.01;
  const bool is_due = has_moved || (stands && inserted_standing_ < kInsertStanding);
  if (!is_due || (answer.is_lost && lost_in_a_row_ % 3 != 0)) return;
  inserted_standing_ = has_moved ? 0 : inserted_standing_ + 1;
  inserted_at_ = pose_;
  map_.insert(points, pose_);
}

}  // namespace deltamap::localization::odometer
