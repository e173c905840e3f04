// SPDX-License-Identifier: Apache-2.0
#include "navigation/safety.hpp"

#include <algorithm>
#include <cmath>

namespace deltamap::navigation {
namespace {

constexpr double kLookAheadM = 5.0;            // no stop distance of a P3-DX is longer
constexpr double kCrawlMPerS = 0.02;           // slower than this is standing
constexpr double kTurnsOnTheSpotMPerS = 0.05;  // below, speed / turn rate is no path any more

double clamped(double value, double most) { return std::clamp(value, -most, most); }

}  // namespace

std::string_view name_of(StopReason reason) {
  switch (reason) {
    case StopReason::kNone:
      return "none";
    case StopReason::kNoCommand:
      return "no command";
    case StopReason::kCommandExpired:
      return "command expired";
    case StopReason::kNoOdometry:
      return "no odometry";
    case StopReason::kStopButton:
      return "stop button";
    case StopReason::kMotorsOff:
      return "motors off";
    case StopReason::kBumper:
      return "bumper";
    case StopReason::kStalled:
      return "stalled";
    case StopReason::kStaleLaser:
      return "stale laser";
    case StopReason::kReverse:
      return "reverse refused";
    case StopReason::kObstacle:
      return "obstacle";
  }
  return "unknown";
}

void Safety::observe(const Scan& scan) {
  scan_ = SeenScan{scan.time, scan.received, obstacles_of(scan, params_.obstacles)};
}

void Safety::command(const DriveCommand& command, Timestamp now) {
  const bool sane = std::isfinite(command.speed_m_per_s) && std::isfinite(command.turn_rate_rad_per_s);
  command_ = sane ? std::optional{HeldCommand{command, now}} : std::nullopt;
}

StopReason Safety::blocking_state(Timestamp now) const {
  if (!command_) return StopReason::kNoCommand;
  if (seconds(now - command_->received) > params_.command_life_s) return StopReason::kCommandExpired;
  if (!odometry_ || seconds(now - odometry_->time) > params_.odometry_life_s) return StopReason::kNoOdometry;
  if (odometry_->stop_button) return StopReason::kStopButton;
  if (!odometry_->motors_enabled) return StopReason::kMotorsOff;
  if (odometry_->front_bumpers != 0 || odometry_->rear_bumpers != 0) return StopReason::kBumper;
  if (odometry_->stalled) return StopReason::kStalled;
  if (!scan_ || seconds(now - scan_->received) > 3.0 * params_.nominal_scan_period_s) return StopReason::kStaleLaser;
  if (command_->command.speed_m_per_s < 0.0) return StopReason::kReverse;
  return StopReason::kNone;
}

/// The stop distance at speed v is v² / 2a + v · (reaction + age of the scan). Answers the greatest speed up to the
/// wished one whose stop distance is free; 0 where the robot, at the speed that it has now, must brake at once.
double Safety::safe_speed(const SeenScan& scan, double speed_m_per_s, double turn_rate_rad_per_s, Timestamp now) const {
  const double blind_s = params_.reaction_s + std::max(0.0, seconds(now - scan.time));
  const double moving_m_per_s = std::max(kTurnsOnTheSpotMPerS, std::max(speed_m_per_s, odometry_->speed_m_per_s));
  const double keep_m = params_.robot_radius_m + params_.margin_m;
  // Both where the command leads and straight on, which is where the robot slides while it has not yet turned.
  const double free_m =
      std::min(free_path_m(scan.obstacles_in_robot, turn_rate_rad_per_s / moving_m_per_s, keep_m, kLookAheadM),
               free_path_m(scan.obstacles_in_robot, 0.0, params_.robot_radius_m, kLookAheadM));
  const double a = params_.deceleration_m_per_s2;
  const double fitting = a * (std::sqrt(blind_s * blind_s + 2.0 * free_m / a) - blind_s);
  return fitting < kCrawlMPerS ? 0.0 : std::min(speed_m_per_s, fitting);
}

AllowedMotion Safety::allowed(Timestamp now) const {
  const StopReason blocked = blocking_state(now);
  if (blocked != StopReason::kNone) return {0.0, 0.0, blocked};
  const double turn_rate = clamped(command_->command.turn_rate_rad_per_s, params_.max_turn_rate_rad_per_s);
  const double wished = clamped(command_->command.speed_m_per_s, params_.max_speed_m_per_s);
  const bool swing_is_free = nearest_m(scan_->obstacles_in_robot) > params_.robot_radius_m;
  if (wished == 0.0)
    return {0.0, swing_is_free ? turn_rate : 0.0, swing_is_free ? StopReason::kNone : StopReason::kObstacle};
  const double speed = safe_speed(*scan_, wished, turn_rate, now);
  if (speed > 0.0) return {speed, turn_rate, StopReason::kNone};
  return {0.0, swing_is_free ? turn_rate : 0.0, StopReason::kObstacle};
}

}  // namespace deltamap::navigation
