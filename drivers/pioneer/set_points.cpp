// SPDX-License-Identifier: Apache-2.0
#include "drivers/pioneer/set_points.hpp"

#include <algorithm>
#include <cmath>

namespace deltamap::drivers::pioneer {
namespace {

constexpr Duration kEmergencyRepeat{100'000'000};  // a SIP cycle: the next one shows whether the robot stands

bool moves(const DriveCommand& set_point) {
  return set_point.speed_m_per_s != 0.0 || set_point.turn_rate_rad_per_s != 0.0;
}

}  // namespace

void SetPoints::begin_connection(Transmitter& line) {
  next_pulse_ = line.now() + pulse_interval(line.receiver());
  emergency_stop_.reset();
  stand(line);
}

void SetPoints::drive(DriveCommand wanted, Transmitter& line) {
  wanted.speed_m_per_s = std::clamp(wanted.speed_m_per_s, -limits_.max_speed_m_per_s, limits_.max_speed_m_per_s);
  wanted.turn_rate_rad_per_s =
      std::clamp(wanted.turn_rate_rad_per_s, -limits_.max_turn_rate_rad_per_s, limits_.max_turn_rate_rad_per_s);
  const bool is_number = std::isfinite(wanted.speed_m_per_s) && std::isfinite(wanted.turn_rate_rad_per_s);
  if (!is_number) return stop(line);
  if (emergency_stop_ && !moves(wanted)) return emergency_stop(line);  // VEL 0 would withdraw it
  emergency_stop_.reset();
  const bool is_new = !set_point_ || set_point_->speed_m_per_s != wanted.speed_m_per_s ||
                      set_point_->turn_rate_rad_per_s != wanted.turn_rate_rad_per_s;
  set_point_ = wanted;
  if (!is_new) return;
  push(line);
  next_pulse_ = line.now() + pulse_interval(line.receiver());
}

void SetPoints::stop(Transmitter& line) {
  if (set_point_) stand(line);
}

void SetPoints::refuse_motion(Transmitter& line) {
  if (!set_point_ || !moves(*set_point_)) return;
  set_point_ = DriveCommand{line.now(), 0.0, 0.0};
  push(line);
}

void SetPoints::stand(Transmitter& line) {
  set_point_.reset();
  push(line);
}

void SetPoints::push(Transmitter& line) const {
  const DriveCommand set_point = set_point_.value_or(DriveCommand{});
  line.commands().push_set_points(whole_mm(set_point.speed_m_per_s), whole_degrees(set_point.turn_rate_rad_per_s));
}

void SetPoints::emergency_stop(Transmitter& line) {
  const std::optional<Sip>& sip = line.receiver().newest_sip();
  const bool robot_moves = sip && (sip->left_mm_per_s != 0 || sip->right_mm_per_s != 0);
  const bool is_due = !emergency_stop_ || (robot_moves && line.now() - *emergency_stop_ >= kEmergencyRepeat);
  if (is_due) push_emergency_stop(line);
}

void SetPoints::push_emergency_stop(Transmitter& line) {
  set_point_.reset();
  line.commands().drop(CommandNumber::kVel);
  line.commands().drop(CommandNumber::kRvel);
  line.commands().drop(CommandNumber::kEstop);
  line.commands().push_first({CommandNumber::kEstop, {}});
  emergency_stop_ = line.now();
  next_pulse_ = line.now() + pulse_interval(line.receiver());
}

void SetPoints::pulse(Transmitter& line) {
  next_pulse_ = line.now() + pulse_interval(line.receiver());
  if (emergency_stop_) {
    push_emergency_stop(line);
  } else if (set_point_) {
    push(line);
  } else if (line.commands().is_empty()) {
    line.commands().push({CommandNumber::kPulse, {}});
  }
}

void SetPoints::heed_watchdog(Transmitter& line) {
  const Timestamp last_sent = line.commands().last_sent().value_or(line.now());
  next_pulse_ = std::min(next_pulse_, last_sent + pulse_interval(line.receiver()));
}

Duration SetPoints::pulse_interval(const Receiver& receiver) const {
  return std::min(duration_from_seconds(pulse_interval_s_), receiver.watchdog() / 4);
}

}  // namespace deltamap::drivers::pioneer
