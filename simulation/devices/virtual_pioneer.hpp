// SPDX-License-Identifier: Apache-2.0
// The controller of a P3-DX as its serial port shows it (protocols.md A): bytes and time in, bytes and demands on the
// motors out. It knows no port and no world. Its watchdog is the real one (A9): it stops the robot and, at the next
// packet of any kind, lets it resume its old set points.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "core/messages.hpp"
#include "drivers/pioneer/command.hpp"
#include "drivers/pioneer/packet.hpp"
#include "drivers/pioneer/status.hpp"
#include "simulation/devices/controller_faults.hpp"
#include "simulation/devices/robot_kind.hpp"
#include "simulation/devices/serial_line.hpp"
#include "simulation/devices/set_points.hpp"

namespace deltamap::simulation::devices {

struct PioneerSetup {
  std::string model = "p3dx-sh";  ///< the subtype that it tells, and is (robot_kind.hpp)
  unsigned baud = 9600;           ///< while nobody is connected
  double sip_cycle_s = 0.1;       ///< A6
  double watchdog_s = 2.0;        ///< A9
  double battery_v = 12.8;
  int sonars = 8;  ///< 0, 8 or 16
  bool has_bumpers = false;
  bool can_change_baud = true;  ///< AUTOBAUD 1: honours HOSTBAUD
  bool takes_limits = true;     ///< SETV, SETRV, SETA, SETRA are obeyed
};

class VirtualPioneer {
 public:
  VirtualPioneer(const PioneerSetup& setup, Random random);

  /// Bytes from a host whose port stands at this speed.
  void receive(std::span<const std::uint8_t> bytes, unsigned host_baud, Timestamp now);

  /// Range of a sonar in metres, or nothing where it hears no echo.
  using Sonar = std::function<std::optional<double>(int index)>;

  /// Lets time pass: sends the SIPs that are due and lets the watchdog bite. To be called at least every few
  /// milliseconds, and at next_event().
  void advance(Timestamp now, const WheelMotion& motion, const Sonar& sonar);

  [[nodiscard]] std::vector<std::uint8_t> transmitted(Timestamp now, unsigned host_baud) {
    return line_.arrived(now, host_baud);
  }
  /// When there will be something to do or to read.
  [[nodiscard]] std::optional<Timestamp> next_event() const;

  /// What the motors are asked to do now.
  [[nodiscard]] DriveTarget demand() const;

  // What people and power do to a robot.
  void reset(Timestamp now);  ///< power cycle: pose 0, nobody connected, motors off
  void press_stop_button() { motors_enabled_ = false, stop_button_ = true; }
  void release_stop_button() { stop_button_ = false; }
  /// Whether ENABLE 1 is obeyed meanwhile is not documented: here it is.
  void begin_estall() { motors_enabled_ = false, estall_ = true; }
  void end_estall() { estall_ = false; }
  /// What changes in them happens now.
  void suffer(const ControllerFaults& faults, Timestamp now);
  void suffer(const LineFaults& faults);
  void set_witness(SerialLine::Witness witness) { line_.set_witness(std::move(witness)); }
  void fail(std::uint16_t fault_flags) { fault_flags_ = fault_flags; }
  void press_motors_button() { motors_enabled_ = !motors_enabled_ && !stop_button_; }

  [[nodiscard]] bool is_connected() const { return state_ == State::kConnected; }
  [[nodiscard]] bool watchdog_has_fired() const { return watchdog_fired_; }
  [[nodiscard]] bool motors_enabled() const { return motors_enabled_; }
  [[nodiscard]] unsigned baud() const { return line_.baud(); }

 private:
  enum class State { kAwaitingSync0, kAwaitingSync1, kAwaitingSync2, kAwaitingOpen, kConnected, kMaintenance };

  void take(const drivers::pioneer::Command& command, std::span<const std::uint8_t> data, Timestamp now);
  void synchronize(const drivers::pioneer::Command& command, Timestamp now);
  void obey(const drivers::pioneer::Command& command, Timestamp now);
  void set_pose_to_zero();
  void disconnect();
  void set_baud(unsigned baud);
  void send_cycle(Timestamp now, const Sonar& sonar);
  [[nodiscard]] drivers::pioneer::Sip sip(Timestamp now, const Sonar& sonar);
  void add_sonar(drivers::pioneer::Sip& sip, Timestamp now, const Sonar& sonar);
  void add_battery(drivers::pioneer::Sip& sip) const;
  void add_contact(drivers::pioneer::Sip& sip) const;
  [[nodiscard]] std::vector<std::uint8_t> config_frame() const;
  [[nodiscard]] std::vector<std::uint8_t> identity_frame() const;

  PioneerSetup setup_;
  RobotKind kind_;
  ControllerFaults faults_;
  Random random_;
  SerialLine line_;
  drivers::pioneer::PacketDecoder decoder_;

  State state_ = State::kAwaitingSync0;
  Timestamp last_packet_{};
  Timestamp next_sip_{};
  Timestamp opened_{};
  bool watchdog_fired_ = false;
  bool motors_enabled_ = false;
  bool stop_button_ = false;
  bool estall_ = false;
  bool sonar_on_ = false;
  bool encoder_stream_ = false;
  bool io_stream_ = false;
  int sonar_fired_ = 0;
  std::uint16_t fault_flags_ = 0;
  std::optional<int> fake_battery_decivolts_;
  WheelMotion motion_;       // with the pose as the controller counts it, from its last zero
  Pose2 wheels_from_robot_;  // with the pose as the wheels counted it since power-on
  Pose2 wheels_from_zero_;   // where the controller's pose was last set to zero
  SetPoints set_points_;
};

}  // namespace deltamap::simulation::devices
