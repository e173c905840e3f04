// SPDX-License-Identifier: Apache-2.0
#include "navigation/safety.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace deltamap::navigation {
namespace {

constexpr double kCrawlMPerS = 0.02;         // slower than this is standing
constexpr double kControllerCycleS = 0.1;    // A6: so late the controller may notice that its watchdog is due
constexpr double kAccelerationMPerS2 = 0.3;  // of a P3-DX as delivered (A10: TRANSACC)
constexpr double kTurnAccelerationRadPerS2 = radians(100.0);  // of a P3-DX as delivered (A10: ROTACC)
constexpr double kMostTurnRad = 0.5 * std::numbers::pi;       // further on it would go where the laser does not look
constexpr int kHalvings = 7;                                  // of the share of a speed: 5 mm/s of 0.7 m/s
constexpr std::uint8_t kLaserErrorSeverity = 3;               // B6: 3 error, 4 fatal

double clamped(double value, double most) { return std::clamp(value, -most, most); }

Motion scaled(const Motion& motion, double share) {
  return {share * motion.speed_m_per_s, share * motion.turn_rate_rad_per_s};
}

}  // namespace

// --- what is known ---

void Safety::observe(const Scan& scan) {
  scan_ = SeenScan{scan.time, scan.received, obstacles_of(scan, params_.obstacles)};
  if (scan.implausible) implausible_at_ = scan.received;
  latches_[kLaserError].observe(scan.severity >= kLaserErrorSeverity);
}

void Safety::observe(const Odometry& odometry) {
  const bool same_epoch = odometry_ && odometry_->epoch == odometry.epoch;
  if (!same_epoch) motors_were_on_ = false;
  latches_[kBumper].observe(odometry.front_bumpers != 0 || odometry.rear_bumpers != 0);
  latches_[kStalled].observe(odometry.stalled);
  latches_[kControllerFault].observe(odometry.fault_flags != 0);
  latches_[kLowBattery].observe(is_battery_low(odometry));
  // The first time the daemon may have enabled them. After that, within a connection, a person has.
  const bool come_on = same_epoch && odometry.motors_enabled && !odometry_->motors_enabled;
  if (come_on && motors_were_on_) let_drive_again();
  motors_were_on_ = motors_were_on_ || odometry.motors_enabled;
  odometry_ = odometry;
}

bool Safety::is_battery_low(const Odometry& odometry) {
  if (!odometry.low_battery) {
    low_battery_since_.reset();
    return false;
  }
  if (!low_battery_since_) low_battery_since_ = odometry.time;
  return seconds(odometry.time - *low_battery_since_) >= params_.low_battery_s;
}

void Safety::command(const DriveCommand& command, Timestamp now, StopReason held_by) {
  const bool sane = std::isfinite(command.speed_m_per_s) && std::isfinite(command.turn_rate_rad_per_s);
  command_ = sane ? std::optional{HeldCommand{command, now, held_by}} : std::nullopt;
}

void Safety::let_drive_again() {
  for (StopLatch& latch : latches_) latch.release();
}

StopReason Safety::waits_for() const {
  const auto held = std::find_if(latches_.begin(), latches_.end(), [](const StopLatch& l) { return l.is_held(); });
  return held == latches_.end() ? StopReason::kNone : held->reason();
}

// --- what forbids to move at all ---

StopReason Safety::blocking_state(Timestamp now) const {
  if (const StopReason held = waits_for(); held != StopReason::kNone) return held;
  if (const StopReason silent = silence(now); silent != StopReason::kNone) return silent;
  if (odometry_->stop_button) return StopReason::kStopButton;
  // Before the motors: they are not enabled until it is known.
  if (!stopping_.watchdog_s) return StopReason::kWatchdogUnknown;
  if (!odometry_->motors_enabled) return StopReason::kMotorsOff;
  if (!std::isfinite(*stopping_.watchdog_s)) return StopReason::kNoWatchdog;
  if (implausible_at_ && seconds(now - *implausible_at_) < params_.plausible_s) return StopReason::kImplausible;
  if (command_->held_by != StopReason::kNone) return command_->held_by;
  return command_->command.speed_m_per_s < 0.0 ? StopReason::kReverse : StopReason::kNone;
}

StopReason Safety::silence(Timestamp now) const {
  if (!command_) return StopReason::kNoCommand;
  if (seconds(now - command_->received) > params_.command_life_s) return StopReason::kCommandExpired;
  if (!odometry_ || seconds(now - odometry_->time) > params_.odometry_life_s) return StopReason::kNoOdometry;
  const bool is_stale = !scan_ || seconds(now - scan_->received) > 3.0 * params_.nominal_scan_period_s;
  return is_stale ? StopReason::kStaleLaser : StopReason::kNone;
}

// --- how fast ---

Motion Safety::motion_now() const { return {std::max(0.0, odometry_->speed_m_per_s), odometry_->turn_rate_rad_per_s}; }

Coasting Safety::coasting(const Motion& at_first, const Motion& then, double blind_s) const {
  return {.at_first = at_first,
          .at_first_s = blind_s,
          .then = then,
          .then_s = stopping_.watchdog_s.value() + kControllerCycleS,
          .deceleration_m_per_s2 = std::min(params_.deceleration_m_per_s2, stopping_.deceleration_m_per_s2),
          .turn_deceleration_rad_per_s2 = stopping_.turn_deceleration_rad_per_s2};
}

/// The worst case is v · (age of the scan + reaction + watchdog + cycle) + v² / 2a along the commanded arc, as if the
/// robot had its new speed already. While it gathers speed it turns more sharply than that: a second path.
bool Safety::coasts_clear(const Motion& command, double radius_m, double blind_s) const {
  const Motion now = motion_now();
  const bool moves_on = command.speed_m_per_s > 0.0;
  const auto fits = [&](const Coasting& coasting) {
    const CoastingPath path = coasting_path(coasting);
    if (moves_on && path.turned_rad > kMostTurnRad) return false;
    return is_clear(path, scan_->obstacles_in_robot, radius_m);
  };
  const Motion at_once{std::max(now.speed_m_per_s, command.speed_m_per_s), command.turn_rate_rad_per_s};
  Coasting gathering = coasting(now, command, blind_s);
  gathering.acceleration_m_per_s2 = kAccelerationMPerS2;
  gathering.turn_acceleration_rad_per_s2 = kTurnAccelerationRadPerS2;
  return fits(coasting(at_once, command, blind_s)) && fits(gathering);
}

/// Even braking from now on the hull would touch something: only the hardest braking is left.
bool Safety::can_stop_ahead(double blind_s) const {
  const Motion now = motion_now();
  if (now.speed_m_per_s < kCrawlMPerS) return true;
  return is_clear(coasting_path(coasting(now, {}, blind_s)), scan_->obstacles_in_robot, params_.robot_radius_m);
}

/// The greatest share of a motion, on the same arc, that is safe; 0 where none is.
double Safety::safe_share(const Motion& wished, double blind_s) const {
  const double keep_m = params_.robot_radius_m + params_.margin_m;
  if (coasts_clear(wished, keep_m, blind_s)) return 1.0;
  double safe = 0.0;
  double unsafe = 1.0;
  for (int i = 0; i < kHalvings; ++i) {
    const double share = 0.5 * (safe + unsafe);
    (coasts_clear(scaled(wished, share), keep_m, blind_s) ? safe : unsafe) = share;
  }
  return safe;
}

AllowedMotion Safety::allowed(Timestamp now) const {
  const StopReason blocked = blocking_state(now);
  if (blocked != StopReason::kNone) {
    const bool touches = blocked == StopReason::kBumper || blocked == StopReason::kStalled;
    return {0.0, 0.0, blocked, touches};
  }
  const double blind_s = params_.reaction_s + std::max(0.0, seconds(now - scan_->time));
  if (!can_stop_ahead(blind_s)) return {0.0, 0.0, StopReason::kObstacle, true};
  const Motion wished{clamped(command_->command.speed_m_per_s, params_.max_speed_m_per_s),
                      clamped(command_->command.turn_rate_rad_per_s, params_.max_turn_rate_rad_per_s)};
  if (wished.speed_m_per_s > 0.0) {
    const Motion motion = scaled(wished, safe_share(wished, blind_s));
    if (motion.speed_m_per_s >= kCrawlMPerS) return {motion.speed_m_per_s, motion.turn_rate_rad_per_s};
  }
  const bool may_turn = nearest_m(scan_->obstacles_in_robot) > params_.robot_radius_m &&
                        coasts_clear({0.0, wished.turn_rate_rad_per_s}, params_.robot_radius_m, blind_s);
  const bool stands_as_wished = wished.speed_m_per_s == 0.0 && may_turn;
  return {0.0, may_turn ? wished.turn_rate_rad_per_s : 0.0,
          stands_as_wished ? StopReason::kNone : StopReason::kObstacle};
}

}  // namespace deltamap::navigation
