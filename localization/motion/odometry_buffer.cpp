// SPDX-License-Identifier: Apache-2.0
#include "localization/motion/odometry_buffer.hpp"

#include <algorithm>
#include <cmath>

namespace deltamap::localization::motion {
namespace {

constexpr double kClockFellBackS = 1.0;
constexpr double kVelocityBaseS = 0.08;        // shorter bases turn 1 mm steps into noise
constexpr double kLongestVelocityBaseS = 0.5;  // a velocity of longer ago says nothing about now

BodyVelocity velocity_of(const Pose2& motion, double duration_s) {
  const double forward = std::cos(0.5 * motion.theta) * motion.x + std::sin(0.5 * motion.theta) * motion.y;
  return {forward / duration_s, motion.theta / duration_s};
}

bool is_finite(const Odometry& odometry) {
  const Pose2& pose = odometry.odom_from_robot;
  return std::isfinite(pose.x) && std::isfinite(pose.y) && std::isfinite(pose.theta) &&
         std::isfinite(odometry.speed_m_per_s) && std::isfinite(odometry.turn_rate_rad_per_s);
}

/// Constant speed and turn rate: along the chord of the arc.
Pose2 motion_at(const BodyVelocity& velocity, double duration_s) {
  const double turn_rad = velocity.turn_rate_rad_per_s * duration_s;
  const double forward_m = velocity.speed_m_per_s * duration_s;
  return {forward_m * std::cos(0.5 * turn_rad), forward_m * std::sin(0.5 * turn_rad), wrapped_angle(turn_rad)};
}

}  // namespace

OdometryBuffer::OdometryBuffer(const OdometryBufferParams& params)
    : params_{params}, ring_(static_cast<std::size_t>(std::max(2, params.capacity))) {}

void OdometryBuffer::add(const Odometry& odometry) {
  const Pose2 odom_from_robot = frame_ * odometry.odom_from_robot;
  Report fresh{odometry.time,
               odom_from_robot,
               odom_from_robot,
               odometry.epoch,
               {odometry.speed_m_per_s, odometry.turn_rate_rad_per_s},
               slipped_};
  if (!is_finite(odometry)) return;
  const auto join_to = [&](const Report& last) {
    const bool same_frame = fresh.epoch == last.epoch;
    const Pose2 counted = same_frame ? motion_between(last.odom_from_robot, fresh.odom_from_robot) : Pose2{};
    fresh.continuous_odom_from_robot = last.continuous_odom_from_robot * corrected({.motion = counted}, errors_);
  };
  if (count_ > 0 && seconds(newest().time - fresh.time) > kClockFellBackS) begin_anew();
  if (count_ > 0) {
    const Report& last = newest();
    if (fresh.time <= last.time && fresh.epoch == last.epoch) return;
    join_to(last);
    if (fresh.epoch != last.epoch) fresh.time = std::max(fresh.time, last.time);
  } else if (before_restart_) {
    join_to(*before_restart_);
  }
  if (count_ == ring_.size()) {
    ring_[first_] = fresh;
    first_ = (first_ + 1) % ring_.size();
  } else {
    ring_[(first_ + count_) % ring_.size()] = fresh;
    ++count_;
  }
}

void OdometryBuffer::clock_fell_back(Timestamp last_scan) {
  constexpr double kReportsLagS = 0.3;  // the newest report may be so much older than the scan
  if (count_ == 0 || seconds(last_scan - newest().time) > kReportsLagS) return;  // it has fallen back here, too
  begin_anew();
}

void OdometryBuffer::begin_anew() {
  led_until_.reset();
  before_restart_ = newest();
  count_ = 0;
}

std::size_t OdometryBuffer::first_not_before(Timestamp time) const {
  std::size_t low = 0;
  std::size_t high = count_;
  while (low < high) {
    const std::size_t middle = (low + high) / 2;
    if (report(middle).time < time) {
      low = middle + 1;
    } else {
      high = middle;
    }
  }
  return low;
}

std::optional<OdometryAt> OdometryBuffer::at(Timestamp time) const {
  std::optional<OdometryAt> told = told_at(time);
  if (told && led_until_ && time <= *led_until_) told->led_since = led_since_;
  const double lag_s = lag_s_.value_or(errors_.lag_s);
  if (!told || lag_s == 0.0) return told;
  const Timestamp later = time + duration_from_seconds(lag_s);
  const std::optional<OdometryAt> shifted = told_at(later);
  if (shifted->epoch == told->epoch) told->continuous_odom_from_robot = shifted->continuous_odom_from_robot;
  return told;
}

void OdometryBuffer::correct(Timestamp time, const Pose2& slip, const MotionVariance& variance) {
  const std::optional<OdometryAt> told = at(time);
  if (!told) return;
  const auto moved = [&](const Pose2& from) { return from * slip * inverse(from); };
  const Pose2 continuous = moved(told->continuous_odom_from_robot);
  const Pose2 counted = moved(told->odom_from_robot);
  std::size_t first = first_not_before(time + duration_from_seconds(lag_s_.value_or(errors_.lag_s)));
  for (std::size_t i = first > 0 ? first - 1 : 0; i < count_; ++i) {
    Report& report = ring_[(first_ + i) % ring_.size()];
    report.continuous_odom_from_robot = continuous * report.continuous_odom_from_robot;
    report.slipped += variance;
    if (report.epoch == told->epoch) report.odom_from_robot = counted * report.odom_from_robot;
  }
  frame_ = counted * frame_;
  slipped_ += variance;
}

void OdometryBuffer::led_by_scans(Timestamp from, Timestamp to) {
  if (led_until_ != from) led_since_ = from;
  led_until_ = to;
}

std::optional<OdometryAt> OdometryBuffer::told_at(Timestamp time) const {
  if (count_ == 0) return std::nullopt;
  const std::size_t next = first_not_before(time);
  if (next == count_) return extrapolated(newest(), seconds(time - newest().time));
  const Report& after = report(next);
  if (next == 0 || after.time == time) {
    return OdometryAt{after.odom_from_robot, after.epoch, after.continuous_odom_from_robot, after.slipped,
                      seconds(after.time - time)};
  }
  const Report& before = report(next - 1);
  const double since_s = seconds(time - before.time);
  const double gap_s = seconds(after.time - before.time);
  if (before.epoch != after.epoch) {
    const Report& nearer = since_s <= 0.5 * gap_s ? before : after;
    return OdometryAt{nearer.odom_from_robot, nearer.epoch, nearer.continuous_odom_from_robot, nearer.slipped,
                      std::min(since_s, gap_s - since_s)};
  }
  const double share = since_s / gap_s;
  return OdometryAt{interpolated(before.odom_from_robot, after.odom_from_robot, share), before.epoch,
                    interpolated(before.continuous_odom_from_robot, after.continuous_odom_from_robot, share),
                    before.slipped, 0.0};
}

std::optional<double> OdometryBuffer::turned_between(Timestamp from, Timestamp to) const {
  if (count_ == 0 || from < report(0).time || to > newest().time) return std::nullopt;
  const auto heading_at = [this](Timestamp time) {
    const std::size_t next = first_not_before(time);
    const Report& after = report(next);
    if (next == 0 || after.time == time) return std::pair{after.epoch, after.odom_from_robot.theta};
    const Report& before = report(next - 1);
    const double share = seconds(time - before.time) / seconds(after.time - before.time);
    const double turned = turn_between(before.odom_from_robot.theta, after.odom_from_robot.theta);
    // A change of epoch in between makes the two differ.
    return std::pair{before.epoch == after.epoch ? before.epoch : ~before.epoch,
                     before.odom_from_robot.theta + share * turned};
  };
  const auto [first_epoch, first] = heading_at(from);
  const auto [last_epoch, last] = heading_at(to);
  if (first_epoch != last_epoch) return std::nullopt;
  return turn_between(first, last);
}

OdometryAt OdometryBuffer::extrapolated(const Report& last, double ahead_s) const {
  const double reach_s = std::min(ahead_s, params_.extrapolation_s);
  const Pose2 motion = motion_at(newest_velocity(), reach_s);
  return {last.odom_from_robot * motion, last.epoch, last.continuous_odom_from_robot * motion, last.slipped,
          ahead_s - reach_s};
}

BodyVelocity OdometryBuffer::newest_velocity() const {
  const Report& last = newest();
  for (std::size_t back = count_ - 1; back-- > 0;) {
    const Report& earlier = report(back);
    const double base_s = seconds(last.time - earlier.time);
    if (earlier.epoch != last.epoch || base_s > kLongestVelocityBaseS) break;
    if (base_s < kVelocityBaseS) continue;
    return clamped(velocity_of(motion_between(earlier.odom_from_robot, last.odom_from_robot), base_s));
  }
  return clamped(last.reported);
}

BodyVelocity OdometryBuffer::velocity_at(Timestamp time) const {
  if (count_ == 0) return {};
  const Timestamp from = std::max(time - duration_from_seconds(0.5 * kVelocityBaseS), report(0).time);
  const Timestamp to = std::min(time + duration_from_seconds(0.5 * kVelocityBaseS), newest().time);
  const double base_s = seconds(to - from);
  if (base_s < 0.5 * kVelocityBaseS) {
    const double silent_s = seconds(time - newest().time);
    return silent_s > params_.extrapolation_s ? BodyVelocity{} : newest_velocity();
  }
  const Pose2 motion =
      motion_between(told_at(from)->continuous_odom_from_robot, told_at(to)->continuous_odom_from_robot);
  return clamped(velocity_of(motion, base_s));
}

BodyVelocity OdometryBuffer::clamped(const BodyVelocity& velocity) const {
  return {std::clamp(velocity.speed_m_per_s, -params_.max_speed_m_per_s, params_.max_speed_m_per_s),
          std::clamp(velocity.turn_rate_rad_per_s, -params_.max_turn_rate_rad_per_s, params_.max_turn_rate_rad_per_s)};
}

}  // namespace deltamap::localization::motion
