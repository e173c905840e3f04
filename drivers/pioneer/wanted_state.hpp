// SPDX-License-Identifier: Apache-2.0
// Limits, sonar and motors of the connected robot: what it is told until its SIPs and CONFIGpac show it (commands are
// never acknowledged, protocols.md A1), and what its buttons say about the motors.
//
// Safety: whether motors may be enabled is drive_permission's to say; none are before the controller has told its
// watchdog, without which nobody knows how the robot would stop, and none of a robot whose units and hull nobody knows.
#pragma once

#include <optional>
#include <string_view>

#include "core/time.hpp"
#include "drivers/pioneer/drive_permission.hpp"
#include "drivers/pioneer/params.hpp"
#include "drivers/pioneer/transmitter.hpp"

namespace deltamap::drivers::pioneer {

class WantedState {
 public:
  explicit WantedState(const PioneerParams& params)
      : limits_{params.limits},
        sonar_{params.sonar},
        is_to_drive_{params.enable_motors},
        permission_{params.enable_motors, params.drive_switch} {}

  void begin_connection(Transmitter& line);
  /// Repeats what the robot does not show yet. Called at the time of the next check.
  void bring(Transmitter& line);
  [[nodiscard]] Timestamp next_check() const { return next_check_; }
  void check_at(Timestamp time) { next_check_ = time; }

  /// What the newest SIP, whose first byte came then, shows of motors and buttons.
  void watch_motors(Timestamp sip_began, MotorReport::From from, Transmitter& line);
  void operator_switches(bool on, Transmitter& line);
  /// A command has left the queue.
  void note_sent(const Command& command, Timestamp now);

  [[nodiscard]] const DrivePermission& permission() const { return permission_; }
  [[nodiscard]] bool may_be_driven(const Receiver& robot) const;
  /// Why this controller is not driven in this connection, whatever a person says; empty: nothing speaks against it.
  [[nodiscard]] std::string_view why_never_driven(const Receiver& robot) const;

 private:
  void bring_limits(Transmitter& line);
  void bring_sonar(Transmitter& line);
  void bring_motors(Transmitter& line);

  MotionLimits limits_;
  bool sonar_;
  bool is_to_drive_;
  DrivePermission permission_;
  std::optional<Timestamp> enable_sent_;   // ENABLE 1
  std::optional<Timestamp> disable_sent_;  // ENABLE 0 or CLOSE

  // Since the connection began.
  Timestamp next_check_;
  int limit_requests_ = 0;
  int sonar_requests_ = 0;
  int disable_requests_ = 0;
  bool limits_are_told_ = false;
  bool enable_was_sent_ = false;
};

}  // namespace deltamap::drivers::pioneer
