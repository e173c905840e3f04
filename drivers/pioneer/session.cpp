// SPDX-License-Identifier: Apache-2.0
// What comes in, in both modes, and the connected robot: set points, pulse, time-outs. The way to a connection is in
// session_connect.cpp.
#include "drivers/pioneer/session.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <utility>

#include "core/geometry/angle.hpp"

namespace deltamap::drivers::pioneer {
namespace {

constexpr double kCheckIntervalS = 1.0;
constexpr double kControllerCycleS = 0.1;  // A6: so old the newest speed may be
constexpr double kLongestBrakingS = 3.0;   // waited for before CLOSE, whatever the controller reports
constexpr double kVoltsPerDecivolt = 0.1;

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
      units_{params.model, params.by_hand},
      odometry_{units_.model()},
      permission_{params.enable_motors, params.drive_switch},
      idle_baud_{params.baud},
      connected_baud_{params.fast_baud == 0 ? params.baud : known_baud_or_throw(params.fast_baud)} {}

PioneerOutput PioneerSession::on_bytes(std::span<const std::uint8_t> bytes, Timestamp stamp) {
  PioneerOutput out;
  const std::vector<Packet> packets = at_the_controllers_pace(decoder_.decode(bytes, stamp));
  const bool searches = mode_ == SessionMode::kLive && state_ != State::kConnected;
  if (packets.empty() && searches) diagnosis_.hear(bytes);
  for (const Packet& packet : packets) {
    diagnosis_.hear_own_frame();
    take_packet(packet, stamp, out);
    if (mode_ == SessionMode::kListenOnly) continue;
    if (state_ == State::kConnected) {
      answer_while_connected(packet, stamp, out);
    } else {
      answer_while_connecting(packet, stamp, out);
    }
  }
  notice_another_speed(stamp);
  return finished(stamp, std::move(out));
}

/// SIPs that have waited for the reader lie one right behind another in their chunk, but were sent a cycle apart (A6):
/// dated by the line alone the robot would be ten times as fast as it is.
std::vector<Packet> PioneerSession::at_the_controllers_pace(std::vector<Packet> packets) const {
  if (packets.size() < 2) return packets;
  const std::chrono::milliseconds cycle{config_ ? config_->sip_cycle_ms : ConfigPacket{}.sip_cycle_ms};
  std::optional<Timestamp> next;
  std::for_each(packets.rbegin(), packets.rend(), [&](Packet& packet) {
    if (!is_sip(packet.type())) return;
    if (next) packet.first_byte = std::min(packet.first_byte, *next - cycle);
    next = packet.first_byte;
  });
  return packets;
}

void PioneerSession::on_baud(unsigned baud) { decoder_.set_baud(baud); }

void PioneerSession::take_packet(const Packet& packet, Timestamp now, PioneerOutput& out) {
  const std::uint8_t type = packet.type();
  if (is_sip(type)) {
    take_sip(packet, now, out);
  } else if (type == kSync2) {
    take_identity(packet, out);
  } else if (type == kConfigPacket) {
    take_config(packet, now, out);
  } else if (type != kSync0 && type != kSync1) {
    ++content_counts_.unknown;
  }
}

void PioneerSession::take_sip(const Packet& packet, Timestamp now, PioneerOutput& out) {
  const std::optional<Sip> sip = decoded_sip(packet.data);
  if (!sip) {
    ++content_counts_.malformed;
    return;
  }
  newest_sip_ = sip;
  if (newest_sip_->sonar_is_cut) ++content_counts_.malformed;
  const std::chrono::milliseconds latency{config_ ? config_->kinematics_delay_ms : 0};
  Odometry odometry =
      odometry_.observe(*newest_sip_, odometry_times_.next(packet.first_byte - latency, packet.received));
  odometry.low_battery =
      config_ && odometry.battery_v > 0.0 && odometry.battery_v <= kVoltsPerDecivolt * config_->low_battery_decivolts;
  odometry.fault_flags = newest_sip_->fault_flags.value_or(0);
  out.odometry.push_back(odometry);
  if (mode_ == SessionMode::kLive) watch_motors(packet.first_byte, now, out);
}

void PioneerSession::take_identity(const Packet& packet, PioneerOutput& out) {
  config_.reset();  // of an earlier connection
  const std::optional<RobotIdentity> identity = decoded_identity(packet.data);
  if (!identity) {  // the bare echo of an old controller, or CLOSE come back
    ++content_counts_.malformed;
    return;
  }
  identity_ = identity;
  units_.forget();
  odometry_.begin_epoch();
  out.output.log.push_back("robot name=" + identity->name + " type=" + identity->type +
                           " subtype=" + identity->subtype);
  use_units_of(identity->subtype, out);
}

void PioneerSession::take_config(const Packet& packet, Timestamp now, PioneerOutput& out) {
  std::optional<ConfigPacket> config = decoded_config(packet.data);
  if (!config) {
    ++content_counts_.malformed;
    return;
  }
  const bool is_first = !knows_watchdog();
  config_ = std::move(config);
  if (is_first && knows_watchdog()) next_check_ = now;
  use_units_of(config_->subtype, out);
}

void PioneerSession::use_units_of(const std::string& subtype, PioneerOutput& out) {
  RobotUnits::Line line = units_.hear(subtype);
  odometry_.set_model(units_.model());
  if (!line.text.empty()) (line.is_warning ? out.output.warnings : out.output.log).push_back(std::move(line.text));
}

void PioneerSession::answer_while_connected(const Packet& packet, Timestamp now, PioneerOutput& out) {
  const std::uint8_t type = packet.type();
  if (is_sip(type)) {
    last_sip_ = now;
  } else if (type == kSync0) {
    // Only a robot that waits for a connection echoes PULSE as SYNC0.
    state_ = State::kQuieting;
    leave("robot was reset: it waits for a connection");
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
  } else if (state_ != State::kLeaving) {
    time_out_while_connecting(now, out);
  }
  return finished(now, std::move(out));
}

void PioneerSession::keep_alive(Timestamp now, PioneerOutput& out) {
  if (now - last_sip_ >= duration_from_seconds(params_.sip_timeout_s)) {
    return leave("robot has been silent for " + std::to_string(std::lround(params_.sip_timeout_s * 1e3)) + " ms");
  }
  if (now >= next_check_) {
    bring_robot_to_wanted_state(now, out);
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

PioneerOutput PioneerSession::close(Timestamp now) {
  PioneerOutput out;
  if (mode_ == SessionMode::kListenOnly || state_ == State::kIdle) return out;
  const double time_to_stand_s = this->time_to_stand_s();
  leave(std::nullopt, now + duration_from_seconds(std::min(time_to_stand_s, kLongestBrakingS)));
  if (owes_close_ && time_to_stand_s > kLongestBrakingS) {
    owes_close_ = false;
    out.output.log.push_back("robot is told to stop and not let go: by what it reports it stands in " +
                             std::to_string(std::lround(time_to_stand_s)) +
                             " s; its motors stay on, and hold it, until the next start");
  }
  return finished(now, std::move(out));
}

/// CLOSE takes the current from the motors and our deceleration from the controller: a robot that still moves then
/// rolls on, so one that would move for long is not closed. Only a robot that we have opened hears CLOSE, one that
/// waits for a connection may take it amiss; and only at our own wish: where the link has failed, the SIPs of the
/// connection that is left over will tell what buttons were pressed meanwhile, and CLOSE would wipe that out.
void PioneerSession::leave(std::optional<std::string> reason, Timestamp close_at) {
  const bool has_opened = state_ == State::kOpening || state_ == State::kConnected || state_ == State::kSwitching;
  owes_close_ = has_opened && !reason;
  push_stop();
  state_ = State::kLeaving;
  deadline_ = close_at;
  left_for_ = std::move(reason);
}

double PioneerSession::time_to_stand_s() const {
  if (!newest_sip_) return 0.0;
  const double faster_m_per_s =
      1e-3 * std::max(std::abs(newest_sip_->left_mm_per_s), std::abs(newest_sip_->right_mm_per_s));
  if (faster_m_per_s == 0.0) return 0.0;
  return faster_m_per_s / stopping_limits().deceleration_m_per_s2 + kControllerCycleS;
}

Duration PioneerSession::watchdog() const {
  constexpr unsigned kDefaultMs = 2000;
  const unsigned told_ms = config_ ? config_->watchdog_ms.value_or(0) : 0;
  return std::chrono::milliseconds{told_ms > 0 ? told_ms : kDefaultMs};
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
  while (const std::optional<Command> command = queue_.take_due(now, baud())) {
    const bool enables = *command == Command{CommandNumber::kEnable, 1};
    if (enables) enable_sent_ = now;
    if (enables) permission_.enable_is_sent();
    enable_was_sent_ = enable_was_sent_ || enables;
    if (*command == Command{CommandNumber::kEnable, 0} || command->number == CommandNumber::kClose) disable_sent_ = now;
    out.output.requests.push_back({PortRequest::Kind::kWrite, encoded_command(*command), 0});
  }
}

Timestamp PioneerSession::next_wake() const {
  Timestamp wake_at = deadline_;
  if (state_ == State::kConnected) {
    wake_at = std::min({next_pulse_, next_check_, last_sip_ + duration_from_seconds(params_.sip_timeout_s)});
  }
  const std::optional<Timestamp> due = queue_.next_due();
  if (!due) return wake_at;
  const bool waits_for_queue = state_ == State::kQuieting || state_ == State::kObserving || state_ == State::kClosing ||
                               state_ == State::kSwitching || state_ == State::kLeaving;
  return waits_for_queue ? *due : std::min(wake_at, *due);
}

PioneerOutput PioneerSession::finished(Timestamp now, PioneerOutput out) {
  if (mode_ == SessionMode::kListenOnly || state_ == State::kIdle) return out;
  write_due(now, out);
  if (owes_close_ && queue_.is_empty() && now >= deadline_) {
    owes_close_ = false;
    queue_.push({CommandNumber::kClose, {}});
    write_due(now, out);
  }
  if (state_ == State::kLeaving && queue_.is_empty() && !owes_close_) {
    state_ = State::kIdle;
    out.output.failed = std::exchange(left_for_, std::nullopt);
  } else {
    out.output.wake_at = next_wake();
  }
  return out;
}

}  // namespace deltamap::drivers::pioneer
