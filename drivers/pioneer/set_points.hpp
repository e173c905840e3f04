// SPDX-License-Identifier: Apache-2.0
// How the connected robot is to move: the set point, repeated until the next one, or the emergency stop that holds it;
// and, where there is neither, the pulse that keeps its watchdog fed (protocols.md A9).
#pragma once

#include <optional>

#include "core/messages.hpp"
#include "core/time.hpp"
#include "drivers/pioneer/motion_limits.hpp"
#include "drivers/pioneer/transmitter.hpp"

namespace deltamap::drivers::pioneer {

class SetPoints {
 public:
  /// The robot is spoken to at least every `pulse_interval_s`, or four times within its watchdog's time.
  SetPoints(const MotionLimits& limits, double pulse_interval_s)
      : limits_{limits}, pulse_interval_s_{pulse_interval_s} {}

  void begin_connection(Transmitter& line);
  /// A set point within the limits. One that is no number stops the robot; one of zero leaves an emergency stop alone.
  void drive(DriveCommand wanted, Transmitter& line);
  /// The robot is to stand, and then only the pulse goes out.
  void stop(Transmitter& line);
  /// The robot may not be driven any more: it is to stand where it was to move.
  void refuse_motion(Transmitter& line);
  /// ESTOP, again as long as SIPs show that the robot moves, then in place of the pulse.
  void emergency_stop(Transmitter& line);
  /// VEL 0 and RVEL 0, before all that waits.
  void stand(Transmitter& line);
  void forget() { set_point_.reset(); }

  [[nodiscard]] Timestamp next_pulse() const { return next_pulse_; }
  void pulse_at(Timestamp time) { next_pulse_ = time; }
  /// Called at the time of the next pulse.
  void pulse(Transmitter& line);
  /// The robot has told its watchdog, which may be shorter than we thought.
  void heed_watchdog(Transmitter& line);

 private:
  void push(Transmitter& line) const;
  void push_emergency_stop(Transmitter& line);
  [[nodiscard]] Duration pulse_interval(const Receiver& receiver) const;

  MotionLimits limits_;
  double pulse_interval_s_;
  std::optional<DriveCommand> set_point_;
  std::optional<Timestamp> emergency_stop_;  // when ESTOP went out last, while the robot is held by it
  Timestamp next_pulse_;
};

}  // namespace deltamap::drivers::pioneer
