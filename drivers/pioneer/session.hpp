// SPDX-License-Identifier: Apache-2.0
// The conversation with a Pioneer's controller: finds its baud, stops whatever it was doing, connects, keeps its
// watchdog fed, drives it, and turns its SIPs into Odometry (protocols.md A4, A8, A9). Knows no port and no clock.
//
// Safety: SYNC0 has the bytes of PULSE, and any packet lets a robot that its watchdog stopped resume its old set
// points. So at every baud ESTOP, VEL 0, RVEL 0 and CLOSE go out before the first SYNC0, and after a gap in our own
// sending VEL 0 and RVEL 0 go out before anything else. Motors are never enabled unless the parameters say so.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "core/angle.hpp"
#include "core/messages.hpp"
#include "core/time.hpp"
#include "drivers/decoder_counts.hpp"
#include "drivers/pioneer/command.hpp"
#include "drivers/pioneer/command_queue.hpp"
#include "drivers/pioneer/config_packet.hpp"
#include "drivers/pioneer/extra_packets.hpp"
#include "drivers/pioneer/motion_limits.hpp"
#include "drivers/pioneer/odometry.hpp"
#include "drivers/pioneer/packet.hpp"
#include "drivers/session.hpp"

namespace deltamap::drivers::pioneer {

struct PioneerParams {
  std::string model = "p3dx-sh";   ///< until the robot names itself: "p3dx" or "p3dx-sh"
  unsigned baud = 9600;            ///< tried first: 9600, 19200, 38400, 57600 or 115200
  unsigned fast_baud = 0;          ///< switched to once connected, where the robot's AUTOBAUD allows; 0: stay
  bool enable_motors = false;      ///< allowed to send ENABLE 1, once a connection and never after the STOP button
  bool sonar = false;              ///< keep the sonar on: longer SIPs
  double max_speed_m_per_s = 0.4;  ///< set points are clamped to it, (0, 2.2]
  double max_turn_rate_rad_per_s = radians(50.0);  ///< set points are clamped to it, (0, 8.7]
  double pulse_interval_s = 0.5;  ///< packets to the robot at least this often; well below its watchdog of 2 s
  double sip_timeout_s = 1.0;     ///< silence after which the session has failed
};

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
  void on_baud(unsigned baud);

  /// A set point, repeated until the next one, stop_driving() or close(). Ignored unless connected.
  [[nodiscard]] PioneerOutput drive(const DriveCommand& command, Timestamp now);
  [[nodiscard]] PioneerOutput stop_driving(Timestamp now);
  /// ESTOP: stops it as fast as its motors can, whatever deceleration is set. To be called as long as it holds: ESTOP
  /// goes out again until SIPs show that the robot stands, then in place of the pulse. Ended by drive().
  [[nodiscard]] PioneerOutput emergency_stop(Timestamp now);
  /// Stops the robot and takes leave; nothing is sent after it.
  [[nodiscard]] PioneerOutput close(Timestamp now);

  /// SIPs come and commands are heard.
  [[nodiscard]] bool is_connected() const { return state_ == State::kConnected; }
  [[nodiscard]] unsigned baud() const { return decoder_.baud(); }
  [[nodiscard]] DecoderCounts counts() const;
  /// What the robot said about itself, once it did.
  [[nodiscard]] const std::optional<RobotIdentity>& identity() const { return identity_; }
  [[nodiscard]] const std::optional<ConfigPacket>& config() const { return config_; }
  /// How the robot comes to rest without us, by what its controller has confirmed.
  [[nodiscard]] StoppingLimits stopping_limits() const { return stopping_limits_of(config_); }

 private:
  enum class State {
    kIdle,       // not started, closed, failed, or listening only
    kQuieting,   // whatever the robot was doing is being stopped and its connection closed
    kSyncing,    // SYNC0, SYNC1, SYNC2, each awaiting its echo
    kOpening,    // OPEN sent, awaiting the first SIP
    kConnected,  // SIPs come
    kSwitching   // HOSTBAUD sent, awaiting any packet at the new speed
  };
  enum class SwitchStep { kAnnounced, kSpeedSet, kAwaitingPacket };

  // What comes in (both modes).
  void take_packet(const Packet& packet, PioneerOutput& out);
  void take_sip(const Packet& packet, PioneerOutput& out);
  void take_identity(const Packet& packet, PioneerOutput& out);
  void take_config(const Packet& packet, PioneerOutput& out);
  void use_model_of(const std::string& subtype, PioneerOutput& out);

  // The way to a connection (live).
  void try_baud(Timestamp now, PioneerOutput& out);
  void begin_quieting(Timestamp now);
  void send_sync(std::uint8_t step, Timestamp now);
  void answer_while_connecting(const Packet& packet, Timestamp now, PioneerOutput& out);
  void take_echo(const Packet& packet, Timestamp now, PioneerOutput& out);
  void time_out_while_connecting(Timestamp now, PioneerOutput& out);
  void begin_connection(Timestamp now, PioneerOutput& out);
  void begin_switch(Timestamp now, PioneerOutput& out);
  void continue_switch(Timestamp now, PioneerOutput& out);

  // The connection (live).
  void answer_while_connected(const Packet& packet, Timestamp now, PioneerOutput& out);
  void keep_alive(Timestamp now, PioneerOutput& out);
  void bring_robot_to_wanted_state();
  void push_set_points();
  void push_emergency_stop(Timestamp now);
  void fail(std::string reason, Timestamp now, PioneerOutput& out);
  [[nodiscard]] Duration watchdog() const;
  [[nodiscard]] Duration pulse_interval() const;

  void set_baud(unsigned baud, PioneerOutput& out);
  void write_all(Timestamp now, PioneerOutput& out);
  void write_due(Timestamp now, PioneerOutput& out);
  [[nodiscard]] PioneerOutput finished(Timestamp now, PioneerOutput out);

  PioneerParams params_;
  SessionMode mode_;
  PacketDecoder decoder_;
  OdometryTracker odometry_;
  DecoderCounts content_counts_;  // malformed and unknown, on top of the decoder's own
  std::optional<RobotIdentity> identity_;
  std::optional<ConfigPacket> config_;
  std::optional<Sip> newest_sip_;

  State state_ = State::kIdle;
  CommandQueue queue_;
  std::vector<unsigned> bauds_;  // in the order of trying
  std::size_t attempt_ = 0;
  int tries_ = 0;  // at this baud
  std::uint8_t sync_step_ = 0;
  Timestamp deadline_;  // of the present step

  // Since the connection began.
  Timestamp last_sip_;
  Timestamp next_pulse_;
  Timestamp next_check_;
  std::optional<DriveCommand> set_point_;
  std::optional<Timestamp> emergency_stop_;  // when ESTOP went out last, while the robot is held by it
  int config_requests_ = 0;
  int sonar_requests_ = 0;
  int enable_requests_ = 0;
  bool may_enable_ = false;
  bool switch_tried_ = false;
  SwitchStep switch_step_ = SwitchStep::kAnnounced;
  unsigned slow_baud_ = 0;
};

}  // namespace deltamap::drivers::pioneer
