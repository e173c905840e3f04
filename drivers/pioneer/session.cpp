// SPDX-License-Identifier: Apache-2.0
#include "drivers/pioneer/session.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <utility>

namespace deltamap::drivers::pioneer {
namespace {

unsigned known_baud_or_throw(unsigned baud) {
  if (!host_baud_code(baud)) {
    throw std::invalid_argument("robot baud " + std::to_string(baud) + " is unknown: 9600 to 115200");
  }
  return baud;
}

}  // namespace

PioneerSession::PioneerSession(const PioneerParams& params, SessionMode mode)
    : mode_{mode},
      sip_timeout_s_{params.sip_timeout_s},
      receiver_{params},
      connector_{known_baud_or_throw(params.baud),
                 params.fast_baud == 0 ? params.baud : known_baud_or_throw(params.fast_baud)},
      baud_switch_{params.fast_baud},
      wanted_{params},
      set_points_{params.limits, params.pulse_interval_s} {}

Transmitter PioneerSession::line_for(PioneerOutput& out, Timestamp now) {
  return {receiver_, commands_, now, out.output};
}

PioneerOutput PioneerSession::start(Timestamp now) {
  PioneerOutput out;
  if (mode_ == SessionMode::kListenOnly) return out;
  Transmitter line = line_for(out, now);
  diagnosis_.reset();
  set_points_.forget();
  state_ = State::kConnecting;
  connector_.start(line);
  return finished(now, std::move(out));
}

PioneerOutput PioneerSession::on_bytes(std::span<const std::uint8_t> bytes, Timestamp stamp) {
  PioneerOutput out;
  Transmitter line = line_for(out, stamp);
  const std::vector<Packet> packets = receiver_.decode(bytes, stamp);
  if (packets.empty() && mode_ == SessionMode::kLive && !is_connected()) diagnosis_.hear(bytes);
  for (const Packet& packet : packets) {
    diagnosis_.hear_own_frame();
    take(packet, line, out);
    answer(packet, line);
  }
  if (state_ == State::kConnecting) connector_.notice_another_speed(receiver_, stamp);
  watch_line(stamp, out.output);
  return finished(stamp, std::move(out));
}

PioneerOutput PioneerSession::on_time(Timestamp now) {
  PioneerOutput out;
  Transmitter line = line_for(out, now);
  if (state_ == State::kConnecting) {
    connector_.time_out(line);
    go_on_connecting(line);
  } else if (state_ == State::kConnected) {
    keep_alive(line);
  } else if (state_ == State::kSwitching) {
    baud_switch_.time_out(line);
    go_on_switching(line);
  }
  return finished(now, std::move(out));
}

PioneerOutput PioneerSession::drive(const DriveCommand& command, Timestamp now) {
  PioneerOutput out;
  Transmitter line = line_for(out, now);
  const bool may_drive = permission().holds() && wanted_.may_be_driven(receiver_);
  if (is_connected()) set_points_.drive(may_drive ? command : DriveCommand{command.time, 0.0, 0.0}, line);
  return finished(now, std::move(out));
}

PioneerOutput PioneerSession::stop_driving(Timestamp now) {
  PioneerOutput out;
  Transmitter line = line_for(out, now);
  set_points_.stop(line);
  return finished(now, std::move(out));
}

PioneerOutput PioneerSession::emergency_stop(Timestamp now) {
  PioneerOutput out;
  Transmitter line = line_for(out, now);
  if (is_connected()) set_points_.emergency_stop(line);
  return finished(now, std::move(out));
}

PioneerOutput PioneerSession::switch_drive(bool on, Timestamp now) {
  PioneerOutput out;
  Transmitter line = line_for(out, now);
  wanted_.operator_switches(on, line);
  if (!on) set_points_.stop(line);
  return finished(now, std::move(out));
}

PioneerOutput PioneerSession::close(Timestamp now) {
  PioneerOutput out;
  if (state_ == State::kIdle) return out;
  Transmitter line = line_for(out, now);
  const bool is_opening = state_ == State::kConnecting && connector_.has_opened();
  set_points_.forget();
  farewell_.begin(is_opening || state_ == State::kConnected || state_ == State::kSwitching, line);
  state_ = State::kLeaving;
  return finished(now, std::move(out));
}

bool PioneerSession::stop_button_is_pressed() const {
  return is_connected() && receiver_.newest_sip() && receiver_.newest_sip()->has(sip_flag::kStopped);
}

void PioneerSession::take(const Packet& packet, Transmitter& line, PioneerOutput& out) {
  const bool knew_watchdog = receiver_.knows_watchdog();
  Receiver::Content content = receiver_.take(packet);
  if (!content.log.empty()) line.log(std::move(content.log));
  RobotUnits::Line& units = content.units;
  if (!units.text.empty()) (units.is_warning ? out.output.warnings : out.output.log).push_back(std::move(units.text));
  if (!knew_watchdog && receiver_.knows_watchdog()) wanted_.check_at(line.now());
  if (!content.odometry) return;
  out.odometry.push_back(*content.odometry);
  if (state_ != State::kIdle) watch_motors(packet, line);
}

void PioneerSession::watch_motors(const Packet& sip, Transmitter& line) {
  using From = MotorReport::From;
  const From from = state_ != State::kConnecting ? From::kConnection
                    : connector_.has_opened()    ? From::kOpening
                                                 : From::kLeftOver;
  wanted_.watch_motors(sip.first_byte, from, line);
  if (!permission().holds()) set_points_.refuse_motion(line);
}

void PioneerSession::answer(const Packet& packet, Transmitter& line) {
  if (state_ == State::kConnecting) {
    connector_.hear(packet, line);
    go_on_connecting(line);
  } else if (state_ == State::kConnected) {
    answer_while_connected(packet, line);
  } else if (state_ == State::kSwitching) {
    baud_switch_.hear_packet(line);
    go_on_switching(line);
  }
}

void PioneerSession::answer_while_connected(const Packet& packet, Transmitter& line) {
  const std::uint8_t type = packet.type();
  if (is_sip(type)) {
    last_sip_ = line.now();
  } else if (type == kSync0) {
    // Only a robot that waits for a connection echoes PULSE as SYNC0.
    fail("robot was reset: it waits for a connection", line);
  } else if (type == kConfigPacket && config()) {
    set_points_.heed_watchdog(line);
    if (baud_switch_.is_due(receiver_)) begin_switch(line);
  }
}

void PioneerSession::go_on_connecting(Transmitter& line) {
  using Result = Connector::Result;
  if (connector_.result() == Result::kConnected) {
    begin_connection(line);
  } else if (connector_.result() == Result::kNobodyAnswers) {
    fail("robot does not answer at " + connector_.tried_bauds() + " baud: " + diagnosis_.phrase(), line);
  } else if (connector_.result() == Result::kStaysConnected) {
    fail("robot stays connected to a client that has gone", line);
  }
}

void PioneerSession::begin_connection(Transmitter& line) {
  line.log("robot connected baud=" + std::to_string(baud()));
  state_ = State::kConnected;
  last_sip_ = line.now();
  baud_switch_.forget();
  wanted_.begin_connection(line);
  set_points_.begin_connection(line);
}

void PioneerSession::keep_alive(Transmitter& line) {
  if (line.now() - last_sip_ >= duration_from_seconds(sip_timeout_s_)) {
    return fail("robot has been silent for " + std::to_string(std::lround(sip_timeout_s_ * 1e3)) + " ms", line);
  }
  if (line.now() >= wanted_.next_check()) wanted_.bring(line);
  if (line.now() >= set_points_.next_pulse()) set_points_.pulse(line);
}

void PioneerSession::begin_switch(Transmitter& line) {
  set_points_.stand(line);
  baud_switch_.begin(line);
  connector_.remember_connection(baud_switch_.fast_baud());
  state_ = State::kSwitching;
}

void PioneerSession::go_on_switching(Transmitter& line) {
  if (!baud_switch_.is_over()) return;
  state_ = State::kConnected;
  last_sip_ = line.now();
  connector_.remember_connection(baud());
  if (baud() != baud_switch_.fast_baud()) set_points_.pulse_at(line.now());  // it has waited for long
}

void PioneerSession::watch_line(Timestamp now, SessionOutput& out) {
  if (!is_connected()) return quality_.forget();
  if (const auto change = quality_.observe(receiver_.counts(), now))
    (change->is_disturbed ? out.warnings : out.log).push_back(change->line);
}

void PioneerSession::fail(std::string reason, Transmitter& line) {
  set_points_.forget();
  farewell_.begin_after_failure(std::move(reason), line);
  state_ = State::kLeaving;
}

void PioneerSession::write_due(Transmitter& line) {
  if (state_ == State::kConnected || state_ == State::kSwitching) stop_after_a_gap(line);
  while (const std::optional<Command> command = commands_.take_due(line.now(), baud())) {
    wanted_.note_sent(*command, line.now());
    line.write(encoded_command(*command));
  }
}

/// A9: after a silence of ours the watchdog may have stopped the robot, and any packet but VEL 0 and RVEL 0 resumes
/// what it was told before. Half of the watchdog's time leaves room for a packet that is lost.
void PioneerSession::stop_after_a_gap(Transmitter& line) {
  if (commands_.is_empty() || !commands_.last_sent()) return;
  const Duration gap = line.now() - *commands_.last_sent();
  if (gap <= receiver_.watchdog() / 2) return;
  line.log("robot was not spoken to for " + std::to_string(std::lround(seconds(gap) * 1e3)) + " ms: stopped");
  commands_.clear();
  set_points_.stand(line);
}

Timestamp PioneerSession::next_wake() const {
  const Timestamp silent_at = last_sip_ + duration_from_seconds(sip_timeout_s_);
  const Timestamp wake_at = state_ == State::kConnecting ? connector_.deadline()
                            : state_ == State::kConnected
                                ? std::min({set_points_.next_pulse(), wanted_.next_check(), silent_at})
                            : state_ == State::kSwitching ? baud_switch_.deadline()
                                                          : farewell_.deadline();
  const std::optional<Timestamp> due = commands_.next_due();
  if (!due) return wake_at;
  const bool waits_for_queue = state_ == State::kConnecting ? connector_.waits_for_queue() : !is_connected();
  return waits_for_queue ? *due : std::min(wake_at, *due);
}

PioneerOutput PioneerSession::finished(Timestamp now, PioneerOutput out) {
  if (state_ == State::kIdle) return out;
  Transmitter line = line_for(out, now);
  write_due(line);
  if (state_ == State::kLeaving && farewell_.pushes_close(line)) write_due(line);
  if (state_ == State::kLeaving && farewell_.is_over(commands_)) {
    state_ = State::kIdle;
    out.output.failed = farewell_.reason();
  } else {
    out.output.wake_at = next_wake();
  }
  return out;
}

}  // namespace deltamap::drivers::pioneer
