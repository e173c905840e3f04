// SPDX-License-Identifier: Apache-2.0
#include "navigation/safety.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

namespace deltamap::navigation {
namespace {

constexpr double kCrawlMPerS = 0.02;         // slower than this is standing
constexpr double kCreepMPerS = 0.1;          // until the laser has shown that it looks ahead: it stands within 0.05 m
constexpr double kControllerCycleS = 0.1;    // A6: so late the controller may notice that its watchdog is due
constexpr double kAccelerationMPerS2 = 0.3;  // of a P3-DX as delivered (A10: TRANSACC)
constexpr double kTurnAccelerationRadPerS2 = radians(100.0);  // of a P3-DX as delivered (A10: ROTACC)
constexpr double kMostTurnRad = 0.5 * std::numbers::pi;       // further on it would go where the laser does not look
constexpr double kOldestViewS = 2.0;                          // an older scan does not tell what is near now
constexpr int kHalvings = 7;                                  // of the share of a speed: 5 mm/s of 0.7 m/s
constexpr std::uint8_t kLaserErrorSeverity = 3;               // B6: 3 error, 4 fatal
constexpr double kLeastBatteryV = 1.0;                        // nothing runs on less: it was not measured

/// Whether something has lasted for so long without a break.
bool lasts(std::optional<Timestamp>& since, bool is_so, Timestamp now, double least_s) {
  if (!is_so) since.reset();
  if (is_so && !since) since = now;
  return is_so && seconds(now - *since) >= least_s;
}

double clamped(double value, double most) { return std::clamp(value, -most, most); }

Motion scaled(const Motion& motion, double share) {
  return {share * motion.speed_m_per_s, share * motion.turn_rate_rad_per_s};
}

}  // namespace

// --- what is known ---

void Safety::observe(const Scan& scan) {
  laser_.observe(scan);
  const Scan believed = laser_.believed(scan);
  lost_ends_.observe(laser_.proven(scan), odom_at(scan));
  scan_ = SeenScan{scan.time, scan.received, fan_of(scan), obstacles_of(believed, params_.obstacles)};
  scan_->obstacles_in_robot.insert(scan_->obstacles_in_robot.end(), lost_ends_.in_robot().begin(),
                                   lost_ends_.in_robot().end());
  if (is_implausible(scan)) implausible_at_ = scan.received;
  latches_[kLaserError].observe(scan.severity >= kLaserErrorSeverity);
  latches_[kWheelsSpin].observe(wheels_spin_ || laser_.motion().contradicts_wheels());
}

/// In one frame since the last call, or nothing: the frame has jumped.
std::optional<Pose2> Safety::odom_at(const Scan& scan) {
  const WheelPath& wheels = laser_.wheels();
  if (std::exchange(lost_ends_epoch_, wheels.epoch()) != wheels.epoch()) return std::nullopt;
  return wheels.odom_from_robot(scan.time);
}

void Safety::observe(const Odometry& odometry) {
  const bool same_epoch = odometry_ && odometry_->epoch == odometry.epoch;
  if (!same_epoch) motors_were_on_ = false;
  laser_.observe(odometry);
  obedience_.observe(odometry, stopping_);
  latches_[kBumper].observe(odometry.front_bumpers != 0 || odometry.rear_bumpers != 0);
  latches_[kStalled].observe(odometry.stalled);
  latches_[kControllerFault].observe(odometry.fault_flags != 0);
  latches_[kLowBattery].observe(lasts(low_battery_since_, odometry.low_battery, odometry.time, params_.low_battery_s));
  latches_[kDisobeys].observe(obedience_.disobeys());
  has_no_battery_ = lasts(no_battery_since_, odometry.battery_v < kLeastBatteryV, odometry.time, params_.no_battery_s);
  // The first time the daemon may have enabled them. After that, within a connection, a person has.
  const bool come_on = same_epoch && odometry.motors_enabled && !odometry_->motors_enabled;
  if (come_on && motors_were_on_) let_drive_again();
  motors_were_on_ = motors_were_on_ || odometry.motors_enabled;
  odometry_ = odometry;
}

void Safety::told(const std::optional<Motion>& motion, Timestamp now) {
  if (!motion) return obedience_.forget();
  obedience_.told(*motion, now);
}

void Safety::command(const DriveCommand& command, Timestamp now, StopReason held_by) {
  const bool sane = std::isfinite(command.speed_m_per_s) && std::isfinite(command.turn_rate_rad_per_s);
  command_ = sane ? std::optional{HeldCommand{command, now, held_by}} : std::nullopt;
}

void Safety::let_drive_again() {
  wheels_spin_ = false;
  ++times_let_drive_;
  const bool was_blind = misses_walls_ || laser_.sees_nothing();
  misses_walls_ = false;
  laser_.begin_anew();
  has_forgotten_blindness_ = was_blind && !laser_.sees_nothing();
  latches_[kWheelsSpin].observe(false);
  for (StopLatch& latch : latches_) latch.release();
}

StopReason Safety::waits_for() const {
  const auto held = std::find_if(latches_.begin(), latches_.end(), [](const StopLatch& l) { return l.is_held(); });
  return held == latches_.end() ? StopReason::kNone : held->reason();
}

StopReason Safety::ends_by_word() const {
  if (const StopReason held = waits_for(); held != StopReason::kNone) return held;
  return misses_walls_ || laser_.sees_nothing() ? StopReason::kLaserBlind : StopReason::kNone;
}

// --- what forbids to move at all ---

StopReason Safety::blocking_state(Timestamp now) const {
  if (const StopReason held = waits_for(); held != StopReason::kNone) return held;
  if (!command_) return StopReason::kNoCommand;
  if (seconds(now - command_->received) > params_.command_life_s) return StopReason::kCommandExpired;
  if (const StopReason unfit_now = unfit(now); unfit_now != StopReason::kNone) return unfit_now;
  if (odometry_->stop_button) return StopReason::kStopButton;
  // Before the motors: they are not enabled until it is known.
  if (!stopping_.watchdog_s) return StopReason::kWatchdogUnknown;
  if (!odometry_->motors_enabled) return StopReason::kMotorsOff;
  if (!std::isfinite(*stopping_.watchdog_s)) return StopReason::kNoWatchdog;
  if (command_->held_by != StopReason::kNone) return command_->held_by;
  return command_->command.speed_m_per_s < 0.0 ? StopReason::kReverse : StopReason::kNone;
}

StopReason Safety::unfit(Timestamp now) const {
  if (const StopReason held = waits_for(); held != StopReason::kNone) return held;
  if (const StopReason robot = unfit_robot(now); robot != StopReason::kNone) return robot;
  return unfit_laser(now);
}

StopReason Safety::unfit_robot(Timestamp now) const {
  if (!odometry_ || seconds(now - odometry_->time) > params_.odometry_life_s) return StopReason::kNoOdometry;
  if (is_unknown_robot_) return StopReason::kUnknownRobot;
  if (odometry_->charging) return StopReason::kCharging;
  return has_no_battery_ ? StopReason::kNoBattery : StopReason::kNone;
}

StopReason Safety::unfit_laser(Timestamp now) const {
  const bool is_stale = !scan_ || seconds(now - scan_->received) > 3.0 * params_.nominal_scan_period_s;
  if (is_stale) return StopReason::kStaleLaser;
  if (!covers_way_ahead(scan_->fan, params_.robot_radius_m + params_.margin_m)) return StopReason::kWayUncovered;
  if (misses_walls_ || laser_.sees_nothing()) return StopReason::kLaserBlind;
  const bool was_implausible = implausible_at_ && seconds(now - *implausible_at_) < params_.plausible_s;
  if (was_implausible) return StopReason::kImplausible;
  return laser_.repeats_itself() ? StopReason::kLaserFrozen : StopReason::kNone;
}

// --- how fast ---

Motion Safety::motion_now() const { return {std::max(0.0, odometry_->speed_m_per_s), odometry_->turn_rate_rad_per_s}; }

Coasting Safety::coasting(const Motion& at_first, const Motion& then, double blind_s) const {
  return {.at_first = at_first,
          .at_first_s = blind_s,
          .then = then,
          .then_s = stopping_.watchdog_s.value_or(0.0) + kControllerCycleS,  // known wherever it is told to go
          .deceleration_m_per_s2 = std::min(params_.deceleration_m_per_s2, stopping_.deceleration_m_per_s2),
          .turn_deceleration_rad_per_s2 = stopping_.turn_deceleration_rad_per_s2};
}

/// The worst case is v · (age of the scan + reaction + watchdog + cycle) + v² / 2a along the commanded arc, as if the
/// robot had its new speed already. While it gathers speed it turns more sharply than that: a second path.
bool Safety::coasts_clear(const Motion& command, double radius_m, const Ground& ground) const {
  const Motion now = motion_now();
  const bool must_be_seen = ground.is_looked_at && command.speed_m_per_s > 0.0;
  const auto fits = [&](const Coasting& coasting) {
    const CoastingPath path = coasting_path(coasting);
    if (must_be_seen && (path.turned_rad > kMostTurnRad || !is_looked_at(path, scan_->fan, radius_m))) return false;
    return is_clear(path, ground.obstacles_in_robot, radius_m);
  };
  const Motion at_once{std::max(now.speed_m_per_s, command.speed_m_per_s), command.turn_rate_rad_per_s};
  Coasting gathering = coasting(now, command, ground.blind_s);
  gathering.acceleration_m_per_s2 = kAccelerationMPerS2;
  gathering.turn_acceleration_rad_per_s2 = kTurnAccelerationRadPerS2;
  return fits(coasting(at_once, command, ground.blind_s)) && fits(gathering);
}

/// How long the robot goes on as it does now, counted from when something was known.
double Safety::unseen_s(Timestamp seen, Timestamp now) const {
  return params_.reaction_s + std::max(0.0, seconds(now - seen));
}

/// Even braking from now on the hull would touch something: only the hardest braking is left.
bool Safety::can_stop_ahead(Timestamp now) const {
  const Motion motion = motion_now();
  if (motion.speed_m_per_s < kCrawlMPerS) return true;
  Coasting braking = coasting(motion, {}, unseen_s(scan_->time, now));
  braking.then_s = 0.0;  // it is told so: that needs no watchdog
  return is_clear(coasting_path(braking), scan_->obstacles_in_robot, params_.robot_radius_m);
}

/// Whatever it is to stand for: it has touched something, goes on all the same, or comes too near to something.
bool Safety::must_brake_hard(Timestamp now) const {
  for (const Latched urgent : {kDisobeys, kBumper, kStalled, kWheelsSpin}) {
    if (latches_[urgent].is_held()) return true;
  }
  const bool is_in_view = scan_ && odometry_ && odometry_->motors_enabled && seconds(now - scan_->time) < kOldestViewS;
  return is_in_view && !can_stop_ahead(now);
}

/// The greatest share of a motion, on the same arc, that is safe; 0 where none is.
double Safety::safe_share(const Motion& wished, const Ground& ground) const {
  const double keep_m = params_.robot_radius_m + params_.margin_m;
  if (coasts_clear(wished, keep_m, ground)) return 1.0;
  double safe = 0.0;
  double unsafe = 1.0;
  for (int i = 0; i < kHalvings; ++i) {
    const double share = 0.5 * (safe + unsafe);
    (coasts_clear(scaled(wished, share), keep_m, ground) ? safe : unsafe) = share;
  }
  return safe;
}

/// Of zones that nobody has placed anew for a while nobody knows where they are by now, near or not.
bool Safety::are_zones_stale(Timestamp now) const { return zones_.bind && seconds(now - zones_.time) > kOldestViewS; }

double Safety::share_before_zones(const Motion& wished, Timestamp now) const {
  if (are_zones_stale(now)) return 0.0;
  if (zones_.blocked_in_robot.empty()) return 1.0;
  return safe_share(wished, {zones_.blocked_in_robot, unseen_s(zones_.time, now), false});
}

/// As slow as it has to creep, and as zones want it, on the same arc.
Motion Safety::slowed(const Motion& wished) const {
  const double most = std::min(creeps() ? kCreepMPerS : params_.max_speed_m_per_s, zones_.most_speed_m_per_s);
  return wished.speed_m_per_s <= most ? wished : scaled(wished, most / wished.speed_m_per_s);
}

AllowedMotion Safety::allowed(Timestamp now) const {
  const bool brake_hard = must_brake_hard(now);
  const StopReason blocked = blocking_state(now);
  if (blocked != StopReason::kNone) return {0.0, 0.0, blocked, brake_hard};
  if (brake_hard) return {0.0, 0.0, StopReason::kObstacle, true};
  const Ground seen = scanned_ground(now);
  StopReason in_the_way = StopReason::kObstacle;
  const Motion wished{clamped(command_->command.speed_m_per_s, params_.max_speed_m_per_s),
                      clamped(command_->command.turn_rate_rad_per_s, params_.max_turn_rate_rad_per_s)};
  if (wished.speed_m_per_s > 0.0) {
    const Motion ahead = slowed(wished);
    const Motion free = scaled(ahead, safe_share(ahead, seen));
    const Motion motion = scaled(free, share_before_zones(free, now));
    if (motion.speed_m_per_s >= kCrawlMPerS) return {motion.speed_m_per_s, motion.turn_rate_rad_per_s};
    if (free.speed_m_per_s >= kCrawlMPerS)
      in_the_way = are_zones_stale(now) ? StopReason::kPoseUnknown : StopReason::kBlockedZone;
  }
  const bool may_turn = nearest_m(scan_->obstacles_in_robot) > params_.robot_radius_m &&
                        coasts_clear({0.0, wished.turn_rate_rad_per_s}, params_.robot_radius_m, seen);
  const bool stands_as_wished = wished.speed_m_per_s == 0.0 && may_turn;
  return {0.0, may_turn ? wished.turn_rate_rad_per_s : 0.0, stands_as_wished ? StopReason::kNone : in_the_way};
}

}  // namespace deltamap::navigation
