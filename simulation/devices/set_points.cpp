// SPDX-License-Identifier: Apache-2.0
#include "simulation/devices/set_points.hpp"

#include <algorithm>
#include <cmath>

namespace deltamap::simulation::devices {
namespace {

using drivers::pioneer::Command;
using drivers::pioneer::CommandNumber;

constexpr double kVel2Unit_m_per_s = 0.02;               // A7: Vel2Divisor 20
constexpr double kEmergencyDeceleration_m_per_s2 = 2.0;  // TRANSACCTOP of the delivered robot
constexpr double kArrived_m = 0.002;
constexpr double kAligned_rad = 0.004;

double metres(int millimetres) { return 0.001 * millimetres; }

/// The speed from which a distance suffices to stop, towards it.
double braking_speed(double distance, double deceleration, double most) {
  return std::copysign(std::min(most, std::sqrt(2.0 * deceleration * std::abs(distance))), distance);
}

}  // namespace

bool SetPoints::is_set_point(CommandNumber number) {
  switch (number) {
    case CommandNumber::kVel:
    case CommandNumber::kRotate:
    case CommandNumber::kRvel:
    case CommandNumber::kVel2:
    case CommandNumber::kMove:
    case CommandNumber::kHead:
    case CommandNumber::kDhead:
    case CommandNumber::kStop:
      return true;
    default:
      return false;
  }
}

bool SetPoints::take(const Command& command, const WheelMotion& motion) {
  switch (command.number) {
    case CommandNumber::kVel:
    case CommandNumber::kRotate:
    case CommandNumber::kRvel:
    case CommandNumber::kVel2:
      take_velocity(command);
      return true;
    case CommandNumber::kMove:
    case CommandNumber::kHead:
    case CommandNumber::kDhead:
      take_goal(command, motion);
      return true;
    case CommandNumber::kStop:
    case CommandNumber::kEstop:
    case CommandNumber::kQstop:
      stop(command.number != CommandNumber::kStop);
      return true;
    case CommandNumber::kSetA:
    case CommandNumber::kSetV:
    case CommandNumber::kSetRa:
    case CommandNumber::kSetRv:
      take_limit(command);
      return true;
    default:
      return false;
  }
}

void SetPoints::set_speed(double speed_m_per_s) {
  speed_m_per_s_ = speed_m_per_s;
  move_to_m_.reset();
  emergency_ = false;
}

void SetPoints::set_turn_rate(double turn_rate_rad_per_s) {
  turn_rate_rad_per_s_ = turn_rate_rad_per_s;
  heading_rad_.reset();
  emergency_ = false;
}

void SetPoints::take_velocity(const Command& command) {
  const int value = command.integer_or(0);
  if (command.number == CommandNumber::kVel) return set_speed(metres(value));
  if (command.number != CommandNumber::kVel2) return set_turn_rate(radians(value));
  const auto pair = drivers::pioneer::byte_pair(value);
  const double left = kVel2Unit_m_per_s * pair.left;
  const double right = kVel2Unit_m_per_s * pair.right;
  set_speed(0.5 * (left + right));
  set_turn_rate(0.5 * (right - left) / kHalfTrack_m);
}

void SetPoints::take_goal(const Command& command, const WheelMotion& motion) {
  const int value = command.integer_or(0);
  if (command.number == CommandNumber::kMove) {
    set_speed(0.0);
    move_to_m_ = motion.travelled_m + metres(value);
    return;
  }
  const double from_rad = command.number == CommandNumber::kDhead ? motion.odom_from_robot.theta : 0.0;
  set_turn_rate(0.0);
  heading_rad_ = wrapped_angle(from_rad + radians(value));
}

void SetPoints::stop(bool at_once) {
  set_speed(0.0);
  set_turn_rate(0.0);
  emergency_ = at_once;
}

void SetPoints::take_limit(const Command& command) {
  const int value = command.integer_or(0);
  if (value == 0) return;
  const double magnitude = std::abs(value);
  if (command.number == CommandNumber::kSetV) max_speed_m_per_s_ = std::min(2.2, 0.001 * magnitude);
  if (command.number == CommandNumber::kSetRv) max_turn_rate_rad_per_s_ = std::min(radians(500), radians(magnitude));
  if (command.number == CommandNumber::kSetA) {
    (value > 0 ? limits_.acceleration_m_per_s2 : limits_.deceleration_m_per_s2) = 0.001 * magnitude;
  }
  if (command.number == CommandNumber::kSetRa) {
    (value > 0 ? limits_.turn_acceleration_rad_per_s2 : limits_.turn_deceleration_rad_per_s2) = radians(magnitude);
  }
}

DriveTarget SetPoints::standstill() const {
  DriveTarget demand = limits_;
  if (emergency_)
    demand.deceleration_m_per_s2 = std::max(kEmergencyDeceleration_m_per_s2, demand.deceleration_m_per_s2);
  return demand;
}

DriveTarget SetPoints::demand(const WheelMotion& motion) const {
  DriveTarget demand = standstill();
  demand.speed_m_per_s = std::clamp(wanted_speed(motion), -max_speed_m_per_s_, max_speed_m_per_s_);
  demand.turn_rate_rad_per_s =
      std::clamp(wanted_turn_rate(motion), -max_turn_rate_rad_per_s_, max_turn_rate_rad_per_s_);
  return demand;
}

double SetPoints::wanted_speed(const WheelMotion& motion) const {
  if (!move_to_m_) return speed_m_per_s_;
  const double left_m = *move_to_m_ - motion.travelled_m;
  return std::abs(left_m) < kArrived_m ? 0.0 : braking_speed(left_m, limits_.deceleration_m_per_s2, max_speed_m_per_s_);
}

double SetPoints::wanted_turn_rate(const WheelMotion& motion) const {
  if (!heading_rad_) return turn_rate_rad_per_s_;
  const double left_rad = turn_between(motion.odom_from_robot.theta, *heading_rad_);
  if (std::abs(left_rad) < kAligned_rad) return 0.0;
  return braking_speed(left_rad, limits_.turn_deceleration_rad_per_s2, max_turn_rate_rad_per_s_);
}

}  // namespace deltamap::simulation::devices
