// SPDX-License-Identifier: Apache-2.0
// Who decides that the motors may be enabled: the configuration, and the last person who switched driving on or off.
// What a person has switched off, only a person switches on: the MOTORS button, or an operator. The owner keeps the
// switch on disk; unknown is off. Pure logic: knows no clock, no port, no file.
#pragma once

#include <cstdint>
#include <optional>
#include <string_view>

namespace deltamap::drivers::pioneer {

/// The last word of a person about driving. Only kOn lets the motors be enabled.
enum class DriveSwitch : std::uint8_t {
  kUnknown,       ///< nobody has said anything yet, or it cannot be read
  kOn,            ///< an operator, or the MOTORS button
  kOffAtRobot,    ///< the STOP or the MOTORS button
  kOffByOperator  ///< stays off whatever button is pressed, until an operator switches on
};
/// "unknown", "on", "off at the robot", "off by the operator".
[[nodiscard]] std::string_view name_of(DriveSwitch value);
[[nodiscard]] std::optional<DriveSwitch> drive_switch_named(std::string_view name);

/// What a SIP says of motors and STOP button, and in which connection it came.
struct MotorReport {
  bool motors_on = false;
  bool stop_button = false;  ///< or E-stall
  enum class From : std::uint8_t {
    kLeftOver,    ///< the robot still was connected to a client that has gone: maybe to us, before a link silence
    kOpening,     ///< the first of our connection: the motors are off after OPEN whoever wants what (protocols.md A4)
    kConnection,  ///< any later one
  } from = From::kConnection;
  bool may_be_our_enable = false;   ///< ENABLE 1 has just been sent: motors that come on are no button
  bool may_be_our_disable = false;  ///< ENABLE 0 or CLOSE has just been sent: motors that go off are no button
};

class DrivePermission {
 public:
  DrivePermission(bool is_configured, DriveSwitch kept) : is_configured_{is_configured}, switch_{kept} {}

  /// ENABLE 1 and set points other than zero may be sent.
  [[nodiscard]] bool holds() const { return is_configured_ && switch_ == DriveSwitch::kOn; }
  /// To be kept.
  [[nodiscard]] DriveSwitch drive_switch() const { return switch_; }
  /// Motors came on by an ENABLE 1 of ours that was still on its way when a person switched off: ENABLE 0 is due.
  [[nodiscard]] bool must_disable() const { return came_on_late_ && !holds(); }

  void operator_switches(bool on) { switch_ = on ? DriveSwitch::kOn : DriveSwitch::kOffByOperator; }
  void observe(const MotorReport& report);
  /// ENABLE 1 goes out: whether the motors are on is open until the next SIP.
  void enable_is_sent() { motors_on_.reset(); }
  /// No SIP has shown the motors on in time: lost on the line, or a person was faster.
  void enable_had_no_effect() { switch_off_at_robot(); }

 private:
  void switch_off_at_robot();

  bool is_configured_;
  DriveSwitch switch_;
  std::optional<bool> motors_on_;  // by the SIP before; nothing: none in this run, or none since ENABLE 1
  bool came_on_late_ = false;
};

}  // namespace deltamap::drivers::pioneer
