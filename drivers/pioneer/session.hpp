// SPDX-License-Identifier: Apache-2.0
// The conversation with a Pioneer's controller (protocols.md A4, A8, A9), seen from outside. It asks its parts in turn:
// the Receiver for what came, in both modes; live, the Connector on the way to a connection; then BaudSwitch,
// WantedState and SetPoints; at last the Farewell. Knows no port and no clock.
//
// Safety: any packet lets a robot that its watchdog stopped resume its old set points. So after a gap in our own
// sending VEL 0 and RVEL 0 go out before anything else; Connector says how a search does without harm, WantedState when
// motors are enabled, and Farewell whom CLOSE may reach.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "core/messages.hpp"
#include "core/time.hpp"
#include "drivers/decoder_counts.hpp"
#include "drivers/line_diagnosis.hpp"
#include "drivers/line_quality.hpp"
#include "drivers/pioneer/baud_switch.hpp"
#include "drivers/pioneer/command_queue.hpp"
#include "drivers/pioneer/connector.hpp"
#include "drivers/pioneer/farewell.hpp"
#include "drivers/pioneer/params.hpp"
#include "drivers/pioneer/receiver.hpp"
#include "drivers/pioneer/set_points.hpp"
#include "drivers/pioneer/wanted_state.hpp"
#include "drivers/session.hpp"

namespace deltamap::drivers::pioneer {

struct PioneerOutput {
  SessionOutput output;
  std::vector<Odometry> odometry;
};

class PioneerSession {
 public:
  /// Throws std::invalid_argument for a model or baud that nobody knows.
  PioneerSession(const PioneerParams& params, SessionMode mode);

  /// The port is open and at any speed: begins with the search. Also the way back after `failed`; epochs go on growing.
  [[nodiscard]] PioneerOutput start(Timestamp now);
  [[nodiscard]] PioneerOutput on_bytes(std::span<const std::uint8_t> bytes, Timestamp stamp);
  [[nodiscard]] PioneerOutput on_time(Timestamp now);
  /// Replays only: the recording says that the line changed its speed.
  void on_baud(unsigned baud) { receiver_.set_baud(baud); }

  /// A set point, repeated until the next one, stop_driving() or close(). Ignored unless connected.
  [[nodiscard]] PioneerOutput drive(const DriveCommand& command, Timestamp now);
  [[nodiscard]] PioneerOutput stop_driving(Timestamp now);
  /// ESTOP: stops it as fast as its motors can, whatever deceleration is set. To be called as long as it holds: ESTOP
  /// goes out again until SIPs show that the robot stands, then in place of the pulse. Ended by a drive() that moves.
  [[nodiscard]] PioneerOutput emergency_stop(Timestamp now);
  /// A person lets it drive, or makes it stand, until a person says otherwise.
  [[nodiscard]] PioneerOutput switch_drive(bool on, Timestamp now);
  /// Stops the robot and, once it stands, takes leave: on_time() sends what has to wait; nothing is sent after it. Over
  /// within 3.5 s, whatever the controller reports: one that would move for longer is told to stop and not closed.
  [[nodiscard]] PioneerOutput close(Timestamp now);
  /// The farewell is not out yet.
  [[nodiscard]] bool is_leaving() const { return state_ == State::kLeaving; }

  /// SIPs come and commands are heard.
  [[nodiscard]] bool is_connected() const { return state_ == State::kConnected; }
  [[nodiscard]] unsigned baud() const { return receiver_.baud(); }
  /// Bytes that are to come before there is anything new to read; 0 where that is not known.
  [[nodiscard]] std::size_t awaited_bytes() const { return receiver_.awaited_bytes(); }
  [[nodiscard]] DecoderCounts counts() const { return receiver_.counts(); }
  [[nodiscard]] const DrivePermission& permission() const { return wanted_.permission(); }
  /// Or E-stall holds it.
  [[nodiscard]] bool stop_button_is_pressed() const;
  /// What the robot said about itself, once it did.
  [[nodiscard]] const std::optional<RobotIdentity>& identity() const { return receiver_.identity(); }
  [[nodiscard]] const std::optional<ConfigPacket>& config() const { return receiver_.config(); }
  /// How the robot comes to rest without us, by what its controller has confirmed.
  [[nodiscard]] StoppingLimits stopping_limits() const { return receiver_.stopping_limits(); }
  /// Why this controller is not driven in this connection, whatever a person says; empty: nothing speaks against it.
  [[nodiscard]] std::string_view why_never_driven() const { return wanted_.why_never_driven(receiver_); }
  /// Nobody knows its hull and its units (robot_units): one of the reasons why it is never driven.
  [[nodiscard]] bool is_unknown_robot() const { return !receiver_.why_never_driven().empty(); }

 private:
  enum class State {
    kIdle,        // not started, closed, failed, or listening only
    kConnecting,  // Connector
    kConnected,   // WantedState, SetPoints
    kSwitching,   // BaudSwitch
    kLeaving      // Farewell
  };

  [[nodiscard]] Transmitter line_for(PioneerOutput& out, Timestamp now);
  void take(const Packet& packet, Transmitter& line, PioneerOutput& out);
  void watch_motors(const Packet& sip, Transmitter& line);
  void answer(const Packet& packet, Transmitter& line);
  void answer_while_connected(const Packet& packet, Transmitter& line);
  void go_on_connecting(Transmitter& line);
  void begin_connection(Transmitter& line);
  void keep_alive(Transmitter& line);
  void begin_switch(Transmitter& line);
  void go_on_switching(Transmitter& line);
  void watch_line(Timestamp now, SessionOutput& out);
  void fail(std::string reason, Transmitter& line);
  void write_due(Transmitter& line);
  void stop_after_a_gap(Transmitter& line);
  [[nodiscard]] Timestamp next_wake() const;
  [[nodiscard]] PioneerOutput finished(Timestamp now, PioneerOutput out);

  SessionMode mode_;
  double sip_timeout_s_;
  State state_ = State::kIdle;
  Timestamp last_sip_;  // while connected
  CommandQueue commands_;
  Receiver receiver_;
  Connector connector_;
  BaudSwitch baud_switch_;
  WantedState wanted_;
  SetPoints set_points_;
  Farewell farewell_;
  LineDiagnosis diagnosis_{Device::kRobot};
  LineQuality quality_{Device::kRobot};  // of the line while it is connected
};

}  // namespace deltamap::drivers::pioneer
