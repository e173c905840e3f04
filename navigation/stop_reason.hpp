// SPDX-License-Identifier: Apache-2.0
// Why the robot must stand. The status shows the reason, the log tells of those that a person should learn of, and
// docs/operating.md says what ends each.
#pragma once

#include <cstdint>
#include <string_view>

namespace deltamap::navigation {

enum class StopReason : std::uint8_t {
  kNone,
  kNoCommand,        ///< nobody drives
  kCommandExpired,   ///< the pilot has fallen silent
  kNoOdometry,       ///< the robot has fallen silent
  kWatchdogUnknown,  ///< the controller has not told it: where the robot would stop is not known
  kNoWatchdog,       ///< the controller would go on for ever if nobody spoke to it
  kStopButton,       ///< pressed
  kMotorsOff,        ///< not enabled, or switched off by a person
  kBumper,           ///< pressed since a person last said drive
  kStalled,          ///< a motor has stalled since a person last said drive
  kControllerFault,  ///< the controller has reported a fault since a person last said drive
  kLowBattery,       ///< the controller has called its battery low since a person last said drive
  kStaleLaser,       ///< no scan for three periods
  kLaserError,       ///< the laser has called its state an error or fatal since a person last said drive
  kImplausible,      ///< the laser flags its own values as implausible
  kPoseUnknown,      ///< the localizer searches
  kLost,             ///< the localizer has lost the robot
  kPoseWrong,        ///< the localizer calls its pose wrong
  kReverse,          ///< backwards is where the laser does not look
  kObstacle          ///< what the laser sees, or could not see, is too near
};

[[nodiscard]] std::string_view name_of(StopReason reason);

/// Ends only when its cause is gone and a person has then said drive.
[[nodiscard]] bool waits_for_person(StopReason reason);

/// Whether the log tells when it begins: what befalls robot, laser or localizer, not what driving brings with it.
[[nodiscard]] bool is_told(StopReason reason);

}  // namespace deltamap::navigation
