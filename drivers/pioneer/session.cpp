// SPDX-License-Identifier: Apache-2.0
// What comes in, in both modes, and the connected robot: set points, pulse, time-outs. The way to a connection is in
// session_connect.cpp.
#include "drivers/pioneer/session.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <utility>

#include "core/angle.hpp"

namespace deltamap::drivers::pioneer {
namespace {

constexpr double kMmPerMetre = 1000.0;
constexpr double kCheckIntervalS = 1.0;
constexpr double kEmergencyRepeatS = 0.1;  // a SIP cycle: the next one shows whether the robot stands
constexpr int kMaxRequests = 5;            // of one state, before we take the robot as it is

RobotModel model_or_throw(const std::string& name) {
  const std::optional<RobotModel> model = model_named(name);
  if (!model) throw std::invalid_argument("robot model \"" + name + "\" is unknown: p3dx or p3dx-sh");
  return *model;
}

unsigned known_baud_or_throw(unsigned baud) {
  if (!host_baud_code(baud)) {
    throw std::invalid_argument("robot baud " + std::to_string(baud) + " is unknown: 9600 to 115200");
  }
  return baud;
}

}  // namespace

PioneerSession::PioneerSession(const PioneerParams& params, SessionMode mode)
    : params_{params},
      mode_{mode},
      decoder_{known_baud_or_throw(params.baud)},
      odometry_{model_or_throw(params.model)} {
  if (params.fast_baud != 0) (void)known_baud_or_throw(params.fast_baud);
}

PioneerOutput PioneerSession::on_bytes(std::span<const std::uint8_t> bytes, Timestamp stamp) {
  PioneerOutput out;
  for (const Packet& packet : decoder_.decode(bytes, stamp)) {
    take_packet(packet, out);
    if (mode_ == SessionMode::kListenOnly) continue;
    if (state_ == State::kConnected) {
      answer_while_connected(packet, stamp, out);
    } else {
      answer_while_connecting(packet, stamp, out);
    }
  }
  return finished(stamp, std::move(out));
}

void PioneerSession::on_baud(unsigned baud) { decoder_.set_baud(baud); }

void PioneerSession::take_packet(const Packet& packet, PioneerOutput& out) {
  const std::uint8_t type = packet.type();
  if (is_sip(type)) {
    take_sip(packet, out);
  } else if (type == kSync2) {
    take_identity(packet, out);
  } else if (type == kConfigPacket) {
    take_config(packet, out);
  } else if (type != kSync0 && type != kSync1) {
    ++content_counts_.unknown;
  }
}

void PioneerSession::take_sip(const Packet& packet, PioneerOutput& out) {
  newest_sip_ = decoded_sip(packet.data);
  if (!newest_sip_) {
    ++content_counts_.malformed;
    return;
  }
  if (newest_sip_->sonar_is_cut) ++content_counts_.malformed;
  const std::chrono::milliseconds latency{config_ ? config_->kinematics_delay_ms : 0};
  out.odometry.push_back(odometry_.observe(*newest_sip_, packet.first_byte - latency));
}

void PioneerSession::take_identity(const Packet& packet, PioneerOutput& out) {
  const std::optional<RobotIdentity> identity = decoded_identity(packet.data);
  if (!identity) {  // the bare echo of an old controller, or CLOSE come back
    ++content_counts_.malformed;
    return;
  }
  identity_ = identity;
  config_.reset();
  odometry_.begin_epoch();
  out.output.log.push_back("robot name=" + identity->name + " type=" + identity->type +
                           " subtype=" + identity->subtype);
  use_model_of(identity->subtype, out);
}

void PioneerSession::take_config(const Packet& packet, PioneerOutput& out) {
  config_ = decoded_config(packet.data);
  if (!config_) {
    ++content_counts_.malformed;
    return;
  }
  use_model_of(config_->subtype, out);
}

void PioneerSession::use_model_of(const std::string& subtype, PioneerOutput& out) {
  if (const std::optional<RobotModel> model = model_named(subtype)) {
    odometry_.set_model(*model);
  } else {
    out.output.log.push_back("robot subtype=" + subtype + " unknown, using model=" + params_.model);
  }
}

void PioneerSession::answer_while_connected(const Packet& packet, Timestamp now, PioneerOutput& out) {
  const std::uint8_t type = packet.type();
  if (is_sip(type)) {
    last_sip_ = now;
    const bool motors_are_on = newest_sip_ && newest_sip_->has(sip_flag::kMotorsEnabled);
    const bool button = newest_sip_ && newest_sip_->has(sip_flag::kStopButton);
    if (motors_are_on || button) may_enable_ = false;  // enabled once, or forbidden by a hand: never again by us
  } else if (type == kSync0) {
    // Only a robot that waits for a connection echoes PULSE as SYNC0.
    fail("robot was reset: it waits for a connection", now, out);
  } else if (type == kConfigPacket && config_) {
    // Its watchdog may be shorter than we thought.
    next_pulse_ = std::min(next_pulse_, queue_.last_sent().value_or(now) + pulse_interval());
    const bool can_switch = config_->auto_baud != 0;
    if (can_switch && !switch_tried_ && params_.fast_baud != 0 && params_.fast_baud != baud()) begin_switch(now, out);
  }
}

PioneerOutput PioneerSession::on_time(Timestamp now) {
  PioneerOutput out;
  if (mode_ == SessionMode::kListenOnly || state_ == State::kIdle) return out;
  if (state_ == State::kConnected) {
    keep_alive(now, out);
  } else if (state_ == State::kSwitching) {
    if (now >= deadline_ && queue_.is_empty()) continue_switch(now, out);
  } else {
    time_out_while_connecting(now, out);
  }
  return finished(now, std::move(out));
}

void PioneerSession::keep_alive(Timestamp now, PioneerOutput& out) {
  if (now - last_sip_ >= duration_from_seconds(params_.sip_timeout_s)) {
    fail("robot has been silent for " + std::to_string(std::lround(params_.sip_timeout_s * 1e3)) + " ms", now, out);
    return;
  }
  if (now >= next_check_) {
    bring_robot_to_wanted_state();
    next_check_ = now + duration_from_seconds(kCheckIntervalS);
  }
  if (now < next_pulse_) return;
  next_pulse_ = now + pulse_interval();
  if (emergency_stop_) {
    push_emergency_stop(now);
  } else if (set_point_) {
    push_set_points();
  } else if (queue_.is_empty()) {
    queue_.push({CommandNumber::kPulse, {}});
  }
}

/// Commands are never acknowledged: they are repeated until SIPs show their effect (A1).
void PioneerSession::bring_robot_to_wanted_state() {
  if (!config_ && config_requests_ < kMaxRequests) {
    ++config_requests_;
    queue_.push({CommandNumber::kConfig, 1});
  }
  if (!newest_sip_) return;
  const bool sonar_is_on = newest_sip_->has(sip_flag::kSonarArrays);
  if (sonar_is_on != params_.sonar && sonar_requests_ < kMaxRequests) {
    ++sonar_requests_;
    queue_.push({CommandNumber::kSonar, params_.sonar ? 1 : 0});
  }
  if (may_enable_ && enable_requests_ < kMaxRequests) {
    ++enable_requests_;
    queue_.push({CommandNumber::kEnable, 1});
  }
}

PioneerOutput PioneerSession::drive(const DriveCommand& command, Timestamp now) {
  PioneerOutput out;
  if (mode_ == SessionMode::kListenOnly || state_ != State::kConnected) return finished(now, std::move(out));
  DriveCommand wanted = command;
  wanted.speed_m_per_s = std::clamp(command.speed_m_per_s, -params_.max_speed_m_per_s, params_.max_speed_m_per_s);
  wanted.turn_rate_rad_per_s =
      std::clamp(command.turn_rate_rad_per_s, -params_.max_turn_rate_rad_per_s, params_.max_turn_rate_rad_per_s);
  const bool is_number = std::isfinite(wanted.speed_m_per_s) && std::isfinite(wanted.turn_rate_rad_per_s);
  if (!is_number) return stop_driving(now);
  emergency_stop_.reset();
  const bool is_new = !set_point_ || set_point_->speed_m_per_s != wanted.speed_m_per_s ||
                      set_point_->turn_rate_rad_per_s != wanted.turn_rate_rad_per_s;
  set_point_ = wanted;
  if (is_new) {
    push_set_points();
    next_pulse_ = now + pulse_interval();
  }
  return finished(now, std::move(out));
}

PioneerOutput PioneerSession::emergency_stop(Timestamp now) {
  PioneerOutput out;
  if (mode_ == SessionMode::kListenOnly || state_ != State::kConnected) return finished(now, std::move(out));
  const bool moves = newest_sip_ && (newest_sip_->left_mm_per_s != 0 || newest_sip_->right_mm_per_s != 0);
  const bool is_due = !emergency_stop_ || (moves && now - *emergency_stop_ >= duration_from_seconds(kEmergencyRepeatS));
  if (is_due) push_emergency_stop(now);
  return finished(now, std::move(out));
}

void PioneerSession::push_emergency_stop(Timestamp now) {
  set_point_.reset();
  queue_.drop(CommandNumber::kVel);
  queue_.drop(CommandNumber::kRvel);
  queue_.drop(CommandNumber::kEstop);
  queue_.push({CommandNumber::kEstop, {}});
  emergency_stop_ = now;
  next_pulse_ = now + pulse_interval();
}

PioneerOutput PioneerSession::stop_driving(Timestamp now) {
  PioneerOutput out;
  if (mode_ == SessionMode::kListenOnly || state_ == State::kIdle) return out;
  if (set_point_ && (state_ == State::kConnected || state_ == State::kSwitching)) {
    set_point_ = DriveCommand{now, 0.0, 0.0};
    push_set_points();
    set_point_.reset();
  }
  return finished(now, std::move(out));
}

void PioneerSession::push_set_points() {
  const double speed = set_point_ ? set_point_->speed_m_per_s : 0.0;
  const double turn_rate = set_point_ ? set_point_->turn_rate_rad_per_s : 0.0;
  queue_.drop(CommandNumber::kVel);
  queue_.drop(CommandNumber::kRvel);
  queue_.push({CommandNumber::kVel, static_cast<int>(std::lround(speed * kMmPerMetre))});
  queue_.push({CommandNumber::kRvel, static_cast<int>(std::lround(degrees(turn_rate)))});
}

PioneerOutput PioneerSession::close(Timestamp now) {
  PioneerOutput out;
  if (mode_ == SessionMode::kListenOnly || state_ == State::kIdle) return out;
  queue_.clear();
  begin_quieting(now);
  write_all(now, out);
  state_ = State::kIdle;
  return out;
}

void PioneerSession::fail(std::string reason, Timestamp now, PioneerOutput& out) {
  queue_.clear();
  begin_quieting(now);  // the robot may still hear us
  write_all(now, out);
  state_ = State::kIdle;
  out.output.failed = std::move(reason);
}

Duration PioneerSession::watchdog() const {
  constexpr unsigned kDefaultMs = 2000;
  return std::chrono::milliseconds{config_ && config_->watchdog_ms > 0 ? config_->watchdog_ms : kDefaultMs};
}

Duration PioneerSession::pulse_interval() const {
  return std::min(duration_from_seconds(params_.pulse_interval_s), watchdog() / 4);
}

DecoderCounts PioneerSession::counts() const {
  DecoderCounts counts = decoder_.counts();
  counts.malformed += content_counts_.malformed;
  counts.unknown += content_counts_.unknown;
  return counts;
}

void PioneerSession::set_baud(unsigned baud, PioneerOutput& out) {
  decoder_.set_baud(baud);
  out.output.requests.push_back({PortRequest::Kind::kSetBaud, {}, baud});
}

void PioneerSession::write_all(Timestamp now, PioneerOutput& out) {
  while (const std::optional<Timestamp> due = queue_.next_due()) {
    std::optional<std::vector<std::uint8_t>> frame = queue_.take_due(std::max(now, *due), baud());
    out.output.requests.push_back({PortRequest::Kind::kWrite, std::move(*frame), 0});
  }
}

void PioneerSession::write_due(Timestamp now, PioneerOutput& out) {
  // A9: after a silence of ours the watchdog may have stopped the robot, and any packet but these two resumes what it
  // was told before. Half of the watchdog's time leaves room for a packet that is lost.
  const bool has_link = state_ == State::kConnected || state_ == State::kSwitching;
  if (has_link && !queue_.is_empty() && queue_.last_sent() && now - *queue_.last_sent() > watchdog() / 2) {
    out.output.log.push_back("robot was not spoken to for " +
                             std::to_string(std::lround(seconds(now - *queue_.last_sent()) * 1e3)) + " ms: stopped");
    queue_.clear();
    set_point_.reset();
    push_set_points();
  }
  while (std::optional<std::vector<std::uint8_t>> frame = queue_.take_due(now, baud())) {
    out.output.requests.push_back({PortRequest::Kind::kWrite, std::move(*frame), 0});
  }
}

PioneerOutput PioneerSession::finished(Timestamp now, PioneerOutput out) {
  if (mode_ == SessionMode::kListenOnly || state_ == State::kIdle) return out;
  write_due(now, out);
  Timestamp wake_at = deadline_;
  if (state_ == State::kConnected) {
    wake_at = std::min({next_pulse_, next_check_, last_sip_ + duration_from_seconds(params_.sip_timeout_s)});
  }
  if (const std::optional<Timestamp> due = queue_.next_due()) {
    const bool waits_for_queue = state_ == State::kQuieting || state_ == State::kSwitching;
    wake_at = waits_for_queue ? *due : std::min(wake_at, *due);
  }
  out.output.wake_at = wake_at;
  return out;
}

}  // namespace deltamap::drivers::pioneer
