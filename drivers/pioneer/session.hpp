// SPDX-License-Identifier: Apache-2.0
// The conversation with a Pioneer's controller: finds its baud, stops whatever it was doing, connects, keeps its
// watchdog fed, drives it, and turns its SIPs into Odometry (protocols.md A4, A8, A9). Knows no port and no clock.
//
// Safety: SYNC0 has the bytes of PULSE, and any packet lets a robot that its watchdog stopped resume its old set
// points. So at every baud ESTOP, VEL 0 and RVEL 0 go out before SYNC0, and after a gap in our own sending VEL 0 and
// RVEL 0 go out before anything else. CLOSE goes only to a robot that has shown by a SIP that it is connected, and not
// to one that has fallen silent: it switches the motors off, and then nobody can tell any more whether a person had.
// Whether motors may be enabled is drive_permission's to say; none are before the controller has told its watchdog, and
// none of a robot whose units and hull nobody knows.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "core/geometry/angle.hpp"
#include "core/messages.hpp"
#include "core/time.hpp"
#include "drivers/decoder_counts.hpp"
#include "drivers/line_diagnosis.hpp"
#include "drivers/monotonic_times.hpp"
#include "drivers/pioneer/baud_search.hpp"
#include "drivers/pioneer/command.hpp"
#include "drivers/pioneer/command_queue.hpp"
#include "drivers/pioneer/config_packet.hpp"
#include "drivers/pioneer/drive_permission.hpp"
#include "drivers/pioneer/extra_packets.hpp"
#include "drivers/pioneer/motion_limits.hpp"
#include "drivers/pioneer/odometry.hpp"
#include "drivers/pioneer/packet.hpp"
#include "drivers/pioneer/robot_units.hpp"
#include "drivers/session.hpp"

namespace deltamap::drivers::pioneer {

struct PioneerParams {
  std::string model = "p3dx-sh";  ///< until the robot names itself: "p3dx" or "p3dx-sh"
  RobotByHand by_hand{};          ///< what a robot of an unknown subtype is driven by
  unsigned baud = 9600;           ///< tried first: 9600, 19200, 38400, 57600 or 115200
  unsigned fast_baud = 0;         ///< switched to once connected, where the robot's AUTOBAUD allows; 0: stay
  bool enable_motors = false;     ///< the configuration lets it drive: one half of drive_permission
  DriveSwitch drive_switch = DriveSwitch::kUnknown;  ///< as the run before has left it: the other half
  bool sonar = false;                                ///< keep the sonar on: longer SIPs
  MotionLimits limits{};          ///< set points are clamped to them, and so does the controller once it was told
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
  [[nodiscard]] unsigned baud() const { return decoder_.baud(); }
  [[nodiscard]] DecoderCounts counts() const;
  [[nodiscard]] const DrivePermission& permission() const { return permission_; }
  /// Or E-stall holds it.
  [[nodiscard]] bool stop_button_is_pressed() const;
  /// What the robot said about itself, once it did.
  [[nodiscard]] const std::optional<RobotIdentity>& identity() const { return identity_; }
  [[nodiscard]] const std::optional<ConfigPacket>& config() const { return config_; }
  /// How the robot comes to rest without us, by what its controller has confirmed.
  [[nodiscard]] StoppingLimits stopping_limits() const { return stopping_limits_of(config_); }
  /// Why this controller is not driven in this connection, whatever a person says; empty: nothing speaks against it.
  [[nodiscard]] std::string_view why_never_driven() const;
  /// Nobody knows its hull and its units (robot_units): one of the reasons why it is never driven.
  [[nodiscard]] bool is_unknown_robot() const { return !units_.why_never_driven().empty(); }

 private:
  enum class State {
    kIdle,       // not started, closed, failed, or listening only
    kQuieting,   // whatever the robot was doing is being stopped; a SIP tells that it is still connected
    kObserving,  // a connection that was left over: a SIP younger than the stop is awaited, then it is closed
    kClosing,    // a connection that was left over is being closed
    kSyncing,    // SYNC0, SYNC1, SYNC2, each awaiting its echo
    kOpening,    // OPEN sent, awaiting the first SIP
    kConnected,  // SIPs come
    kSwitching,  // HOSTBAUD sent, awaiting any packet at the new speed
    kLeaving     // the farewell is being sent
  };
  enum class SwitchStep { kAnnounced, kSpeedSet, kAwaitingPacket };

  // What comes in (both modes).
  [[nodiscard]] std::vector<Packet> at_the_controllers_pace(std::vector<Packet> packets) const;
  void take_packet(const Packet& packet, Timestamp now, PioneerOutput& out);
  void take_sip(const Packet& packet, Timestamp now, PioneerOutput& out);
  void watch_motors(Timestamp sip_began, Timestamp now, PioneerOutput& out);
  void take_identity(const Packet& packet, PioneerOutput& out);
  void take_config(const Packet& packet, Timestamp now, PioneerOutput& out);
  void use_units_of(const std::string& subtype, PioneerOutput& out);

  // The way to a connection (live).
  void probe(Timestamp now, PioneerOutput& out);
  void probe_next(Timestamp now, PioneerOutput& out);
  void begin_quieting();
  void stop_left_over(Timestamp now, PioneerOutput& out);
  void close_left_over(const Packet& sip, Timestamp now);
  void push_stop();
  void notice_another_speed(Timestamp now);
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
  void bring_robot_to_wanted_state(Timestamp now, PioneerOutput& out);
  void bring_limits(PioneerOutput& out);
  void bring_motors(Timestamp now, PioneerOutput& out);
  [[nodiscard]] bool knows_watchdog() const { return config_ && config_->watchdog_ms; }
  [[nodiscard]] bool may_be_driven() const { return knows_watchdog() && units_.why_never_driven().empty(); }
  void push_set_points();
  void push_emergency_stop(Timestamp now);
  void leave(std::optional<std::string> reason, Timestamp close_at = {});
  [[nodiscard]] double time_to_stand_s() const;
  [[nodiscard]] Duration watchdog() const;
  [[nodiscard]] Duration pulse_interval() const;

  void set_baud(unsigned baud, PioneerOutput& out);
  void write_due(Timestamp now, PioneerOutput& out);
  [[nodiscard]] Timestamp next_wake() const;
  [[nodiscard]] PioneerOutput finished(Timestamp now, PioneerOutput out);

  PioneerParams params_;
  SessionMode mode_;
  PacketDecoder decoder_;
  RobotUnits units_;
  OdometryTracker odometry_;
  MonotonicTimes odometry_times_;
  DecoderCounts content_counts_;  // malformed and unknown, on top of the decoder's own
  std::optional<RobotIdentity> identity_;
  std::optional<ConfigPacket> config_;
  std::optional<Sip> newest_sip_;
  DrivePermission permission_;

  State state_ = State::kIdle;
  CommandQueue queue_;
  std::optional<Timestamp> enable_sent_;   // ENABLE 1
  std::optional<Timestamp> disable_sent_;  // ENABLE 0 or CLOSE
  std::optional<std::string> left_for_;    // kLeaving: why the session has failed; nothing: it was closed
  bool owes_close_ = false;                // kLeaving: CLOSE is sent at the deadline

  // The search.
  unsigned idle_baud_;       // where the robot waits for a connection
  unsigned connected_baud_;  // where a connection of ours ended, or would have
  std::vector<BaudProbe> probes_;
  std::size_t probe_ = 0;
  int tries_ = 0;     // of this probe
  int closings_ = 0;  // in this search
  std::uint8_t sync_step_ = 0;
  LineDiagnosis diagnosis_{Device::kRobot};
  bool was_in_vain_ = false;          // the last search found no robot: a laser is asked for, too
  std::uint64_t garbage_before_ = 0;  // bytes, before SYNC0 went out
  Timestamp deadline_;                // of the present step

  // Since the connection began.
  Timestamp last_sip_;
  Timestamp next_pulse_;
  Timestamp next_check_;
  std::optional<DriveCommand> set_point_;
  std::optional<Timestamp> emergency_stop_;  // when ESTOP went out last, while the robot is held by it
  int limit_requests_ = 0;
  int sonar_requests_ = 0;
  int disable_requests_ = 0;
  bool limits_are_told_ = false;
  bool enable_was_sent_ = false;
  bool switch_tried_ = false;
  SwitchStep switch_step_ = SwitchStep::kAnnounced;
  unsigned slow_baud_ = 0;
};

}  // namespace deltamap::drivers::pioneer
