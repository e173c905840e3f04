// SPDX-License-Identifier: Apache-2.0
#include "surveying/calibration/motion_segments.hpp"

#include <cmath>

#include "localization/motion/motion_model.hpp"

namespace deltamap::surveying::calibration {
namespace {

using localization::motion::motion_noise;
using localization::motion::MotionModelParams;
using localization::motion::MotionNoise;
using localization::motion::turn_drive_turn;
using localization::motion::TurnDriveTurn;

constexpr MotionModelParams kNothing{.turn_per_turn = 0.0,
                                     .turn_per_metre_rad = 0.0,
                                     .metre_per_metre = 0.0,
                                     .metre_per_turn_m = 0.0,
                                     .position_floor_m = 0.0,
                                     .heading_floor_rad = 0.0,
                                     .unknown_speed_m_per_s = 0.0,
                                     .unknown_turn_rate_rad_per_s = 0.0};

/// The model with one deviation at 1 and all else at 0.
MotionModelParams unit_of(MotionSource source) {
  MotionModelParams unit = kNothing;
  if (source == MotionSource::kTurnPerTurn) unit.turn_per_turn = 1.0;
  if (source == MotionSource::kTurnPerMetre) unit.turn_per_metre_rad = 1.0;
  if (source == MotionSource::kMetrePerMetre) unit.metre_per_metre = 1.0;
  if (source == MotionSource::kMetrePerTurn) unit.metre_per_turn_m = 1.0;
  return unit;
}

/// How the end moves when the robot's heading is turned at a point on the way.
Eigen::Vector3d by_turn_at(const Point2& at, const Pose2& end) { return {at.y() - end.y, end.x - at.x(), 1.0}; }

Eigen::Matrix3d square(const Eigen::Vector3d& by, double deviation) {
  return deviation * deviation * by * by.transpose();
}

Eigen::Matrix3d estimate_covariance(MotionSource source, const Pose2& end) {
  if (source == MotionSource::kEstimatePosition) return Eigen::Vector3d{2.0, 2.0, 0.0}.asDiagonal();
  return square(by_turn_at({0.0, 0.0}, end), 1.0) + square({0.0, 0.0, 1.0}, 1.0);
}

}  // namespace

MotionSegment motion_segment(const std::vector<Pose2>& first_from_step, const Pose2& first_from_end) {
  constexpr std::array kOfWheels{MotionSource::kTurnPerTurn, MotionSource::kTurnPerMetre, MotionSource::kMetrePerMetre,
                                 MotionSource::kMetrePerTurn};
  MotionSegment segment;
  segment.covariance.fill(Eigen::Matrix3d::Zero());
  if (first_from_step.empty()) return segment;
  const Pose2& end = first_from_step.back();
  segment.disagreement = difference(end, first_from_end);
  Pose2 from;
  for (const Pose2& to : first_from_step) {
    const Pose2 motion = motion_between(from, to);
    const TurnDriveTurn turns = turn_drive_turn(motion);
    const double direction_rad = from.theta + turns.rot1_rad;
    const Eigen::Vector3d by_drive{std::cos(direction_rad), std::sin(direction_rad), 0.0};
    for (const MotionSource source : kOfWheels) {
      const MotionNoise noise = motion_noise(turns, 0.0, unit_of(source));
      segment.covariance[static_cast<std::size_t>(source)] += square(by_turn_at(from.position(), end), noise.rot1_rad) +
                                                              square(by_drive, noise.trans_m) +
                                                              square(by_turn_at(to.position(), end), noise.rot2_rad);
    }
    const double driven_m = motion.position().norm();
    const Eigen::Vector3d by_turn = by_turn_at(0.5 * (from.position() + to.position()), end);
    segment.by_scale.col(0) += Eigen::Vector3d{to.x - from.x, to.y - from.y, 0.0};
    segment.by_scale.col(1) += motion.theta * by_turn;
    segment.by_scale.col(2) += driven_m * by_turn;
    segment.driven_m += driven_m;
    segment.turned_rad += std::abs(motion.theta);
    from = to;
  }
  for (const MotionSource source : {MotionSource::kEstimatePosition, MotionSource::kEstimateHeading}) {
    segment.covariance[static_cast<std::size_t>(source)] = estimate_covariance(source, end);
  }
  return segment;
}

void MotionSegments::observe(const Moment& moment) {
  if (!moment.is_sure) {
    first_.reset();
    return;
  }
  if (!first_ || first_->odometry_epoch != moment.odometry_epoch) {
    begin(moment);
    return;
  }
  const Pose2 first_from_now = motion_between(first_->odom_from_robot, moment.odom_from_robot);
  const Pose2 step = motion_between(steps_.empty() ? Pose2{} : steps_.back(), first_from_now);
  const double step_m = step.position().norm();
  if (step_m < params_.step_m && std::abs(step.theta) < params_.step_rad) return;
  steps_.push_back(first_from_now);
  driven_m_ += step_m;
  turned_rad_ += std::abs(step.theta);
  const std::size_t turn = segments_.size() % params_.length_m.size();
  if (driven_m_ >= params_.length_m[turn] || turned_rad_ >= params_.turn_rad[turn]) close(moment);
}

void MotionSegments::begin(const Moment& moment) {
  first_ = moment;
  steps_.clear();
  driven_m_ = 0.0;
  turned_rad_ = 0.0;
}

void MotionSegments::close(const Moment& moment) {
  segments_.push_back(motion_segment(steps_, motion_between(first_->map_from_robot, moment.map_from_robot)));
  begin(moment);
}

}  // namespace deltamap::surveying::calibration
