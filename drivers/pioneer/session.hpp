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

#include "core/messages.hpp"
#include "core/time.hpp"
#include "drivers/decoder_counts.hpp"
#include "drivers/pioneer/command.hpp"
#include "drivers/pioneer/config_packet.hpp"
#include "drivers/pioneer/extra_packets.hpp"
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
  double max_turn_rate_rad_per_s = 0.87;  ///< set points are clamped to it, (0, 8.7]
  double pulse_interval_s = 0.5;          ///< packets to the robot at least this often; well below its watchdog of 2 s
  double sip_timeout_s = 1.0;             ///< silence after which the session has failed
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
  /// Stops the robot and takes leave; nothing is sent after it.
  [[nodiscard]] PioneerOutput close(Timestamp now);

  /// SIPs come and commands are heard.
  [[nodiscard]] bool is_connected() const { return state_ == State::kConnected; }
  [[nodiscard]] unsigned baud() const { return decoder_.baud(); }
  [[nodiscard]] DecoderCounts counts() const;
  /// What the robot said about itself, once it did.
  [[nodiscard]] const std::optional<RobotIdentity>& identity() const { return identity_; }
  [[nodiscard]] const std::optional<ConfigPacket>& config() const { return config_; }

 private:
  enum class State {
    kIdle,       // not started, closed, failed, or listening only
    kQuieting,   // a left-over connection is being stopped and closed at this baud
    kSyncing,    // SYNC0, SYNC1, SYNC2, each awaiting its echo
    kOpening,    // OPEN sent, awaiting the first SIP
    kConnected,  // SIPs come
    kSwitching   // HOSTBAUD sent, awaiting any packet at the new speed
  };

  void take_packet(const Packet& packet, PioneerOutput& out);
  void take_sip(const Packet& packet, PioneerOutput& out);
  void take_identity(const Packet& packet, PioneerOutput& out);
  void take_config(const Packet& packet, PioneerOutput& out);
  void advance(const Packet& packet, PioneerOutput& out);
  void advance_sync(const Packet& packet, PioneerOutput& out);

  void begin_attempt(Timestamp now, PioneerOutput& out);
  void quiet(Timestamp now, PioneerOutput& out);
  void send_sync(Timestamp now, PioneerOutput& out);
  void open(Timestamp now, PioneerOutput& out);
  void set_up(Timestamp now, PioneerOutput& out);
  void switch_baud(Timestamp now, PioneerOutput& out);
  void next_attempt(Timestamp now, PioneerOutput& out);
  void keep_alive(Timestamp now, PioneerOutput& out);
  void send_set_points(Timestamp now, PioneerOutput& out);
  void enable_motors_once(Timestamp now, PioneerOutput& out);
  void fail(std::string reason, PioneerOutput& out);

  void send(const Command& command, Timestamp now, PioneerOutput& out);
  void set_baud(unsigned baud, PioneerOutput& out);
  void wake_in(double delay_s, Timestamp now);
  [[nodiscard]] PioneerOutput finished(PioneerOutput out) const;

  PioneerParams params_;
  SessionMode mode_;
  PacketDecoder decoder_;
  OdometryTracker odometry_;
  DecoderCounts content_counts_;  // malformed and unknown, on top of the decoder's own
  std::optional<RobotIdentity> identity_;
  std::optional<ConfigPacket> config_;

  State state_ = State::kIdle;
  std::vector<unsigned> bauds_;  // in the order of trying
  std::size_t attempt_ = 0;
  std::uint8_t sync_step_ = 0;
  int tries_ = 0;  // of the present step
  std::optional<Timestamp> wake_at_;
  std::optional<Timestamp> last_sent_;
  std::optional<Timestamp> last_sip_;
  std::optional<DriveCommand> set_point_;
  bool enable_sent_ = false;
  bool stop_button_seen_ = false;
  bool baud_switch_tried_ = false;
};

}  // namespace deltamap::drivers::pioneer
