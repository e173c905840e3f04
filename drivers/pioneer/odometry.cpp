// SPDX-License-Identifier: Apache-2.0
#include "drivers/pioneer/odometry.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <numbers>
#include <string>

namespace deltamap::drivers::pioneer {
namespace {

constexpr int kPositionModulus = 1 << 15;  // 15- and 16-bit senders alike (A8)

/// The change of a counter that wraps, centred on 0: in [-modulus / 2, modulus / 2).
int wrapped_difference(int from, int to, int modulus) {
  const int forward = ((to - from) % modulus + modulus) % modulus;
  return forward < modulus / 2 ? forward : forward - modulus;
}

double heading_rad(const Sip& sip) {
  return wrapped_angle(sip.heading_units * (2.0 * std::numbers::pi / kHeadingUnitsPerTurn));
}

/// Later firmware reports the voltage in two fields, of which an unused one is 0.
double battery_v(const Sip& sip) {
  const std::uint16_t wide = sip.battery_x10_decivolts.value_or(0);
  return 0.1 * (wide > 0 ? wide : sip.battery_decivolts);
}

/// The charge state has no other codes: a byte beyond them is of a controller that has no charger.
bool is_charging(const Sip& sip) {
  constexpr std::uint8_t kBulk = 1;
  constexpr std::uint8_t kBalance = 4;
  const std::uint8_t state = sip.charge_state.value_or(0);
  return sip.has(sip_flag::kChargerPower) || (state >= kBulk && state <= kBalance);
}

}  // namespace

std::optional<RobotModel> model_named(std::string_view subtype) {
  std::string name{subtype};
  std::transform(name.begin(), name.end(), name.begin(),
                 [](char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c; });
  if (name.starts_with("p3dx-sh")) return RobotModel{.metres_per_unit = 0.001};
  if (name == "p3dx") return RobotModel{.metres_per_unit = 0.000485};
  return std::nullopt;
}

void OdometryTracker::set_model(const RobotModel& model) {
  if (model == model_) return;
  model_ = model;
  begin_epoch();
}

void OdometryTracker::begin_epoch() {
  if (!last_) return;
  last_.reset();
  ++epoch_;
}

Odometry OdometryTracker::observe(const Sip& sip, Timestamp time) {
  int dx_units = 0;
  int dy_units = 0;
  int turn_units = 0;
  double elapsed_s = 0.0;
  if (last_) {
    dx_units = wrapped_difference(last_->sip.x_units, sip.x_units, kPositionModulus);
    dy_units = wrapped_difference(last_->sip.y_units, sip.y_units, kPositionModulus);
    turn_units = wrapped_difference(last_->sip.heading_units, sip.heading_units, kHeadingUnitsPerTurn);
    elapsed_s = seconds(time - last_->time);
    if (is_jump(dx_units, dy_units, turn_units, elapsed_s)) begin_epoch();
  }
  if (last_) {
    x_units_ += dx_units;
    y_units_ += dy_units;
  } else {
    x_units_ = 0;
    y_units_ = 0;
    turn_units = 0;
  }
  last_ = Reference{sip, time};

  Odometry odometry;
  odometry.time = time;
  odometry.odom_from_robot = {static_cast<double>(x_units_) * model_.metres_per_unit,
                              static_cast<double>(y_units_) * model_.metres_per_unit, heading_rad(sip)};
  odometry.speed_m_per_s = (sip.left_mm_per_s + sip.right_mm_per_s) / 2.0 * 0.001;
  odometry.turn_rate_rad_per_s = turn_rate_rad_per_s(sip, turn_units, elapsed_s);
  odometry.epoch = epoch_;
  odometry.motors_enabled = sip.has(sip_flag::kMotorsEnabled);
  odometry.stop_button = sip.has(sip_flag::kStopped);
  odometry.stalled = sip.left_stall || sip.right_stall;
  odometry.front_bumpers = sip.front_bumpers;
  odometry.rear_bumpers = sip.rear_bumpers;
  odometry.battery_v = battery_v(sip);
  odometry.charging = is_charging(sip);
  return odometry;
}

double OdometryTracker::turn_rate_rad_per_s(const Sip& sip, int turn_units, double elapsed_s) const {
  if (model_.turn_rate_per_speed > 0.0) {
    return (sip.right_mm_per_s - sip.left_mm_per_s) / 2.0 * model_.turn_rate_per_speed;
  }
  if (sip.turn_rate_decideg_per_s) return radians(0.1 * *sip.turn_rate_decideg_per_s);
  return elapsed_s > 0.0 ? turn_units * (2.0 * std::numbers::pi / kHeadingUnitsPerTurn) / elapsed_s : 0.0;
}

bool OdometryTracker::is_jump(int dx_units, int dy_units, int turn_units, double elapsed_s) const {
  // A8: 3 vmax dt + 0.5 m, or 30 degrees. SIPs come every 100 ms; where some were lost, the turn may be larger in
  // proportion (3 times the flash default of 100 deg/s makes the same 30 degrees in 100 ms).
  constexpr double kSlackFactor = 3.0;
  constexpr double kSlackM = 0.5;
  constexpr double kMaxTurnRad = 30.0 * std::numbers::pi / 180.0;
  constexpr double kUsualTopTurnRate = 100.0 * std::numbers::pi / 180.0;
  const double dt_s = std::max(elapsed_s, 0.0);
  const double step_m = std::hypot(dx_units, dy_units) * model_.metres_per_unit;
  const double turn_rad = std::abs(turn_units) * (2.0 * std::numbers::pi / kHeadingUnitsPerTurn);
  const double wrap_m = kPositionModulus * model_.metres_per_unit;
  const bool is_ambiguous = model_.max_speed_m_per_s * dt_s > wrap_m / 2.0;
  return is_ambiguous || step_m > kSlackFactor * model_.max_speed_m_per_s * dt_s + kSlackM ||
         turn_rad > std::max(kMaxTurnRad, kSlackFactor * kUsualTopTurnRate * dt_s);
}

}  // namespace deltamap::drivers::pioneer
