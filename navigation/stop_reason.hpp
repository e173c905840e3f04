// SPDX-License-Identifier: Apache-2.0
// Why the robot must stand. The status shows the reason, the log tells of those that a person should learn of, and
// docs/operating/why-it-stands.md says what ends each.
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
  kWheelsSpin,       ///< the wheels turned and the scans stood, or went the other way, since a person last said drive
  kDisobeys,         ///< the robot did not do what it was told since a person last said drive
  kUnknownRobot,     ///< the controller names a robot whose hull and units are not known
  kCharging,         ///< the charger is plugged in
  kNoBattery,        ///< the controller reports no battery voltage
  kStaleLaser,       ///< no scan for three periods
  kLaserBlind,       ///< no range has come for a second, or none from a sector that had some
  kLaserFrozen,      ///< the laser repeats the same ranges while the wheels turn
  kWayUncovered,     ///< the laser, as it is mounted, does not look where the robot drives
  kLaserError,       ///< the laser has called its state an error or fatal since a person last said drive
  kImplausible,      ///< the laser flags its own values as implausible
  kPoseUnknown,      ///< the localizer searches
  kLost,             ///< the localizer has lost the robot
  kPoseWrong,        ///< the localizer calls its pose wrong
  kStartUnfit,       ///< the pose that the run was given does not fit the scans
  kPoseUnsure,       ///< the deviation of the position exceeds a metre
  kPoseUnfit,        ///< the scans have not fitted the pose for two seconds
  kReverse,          ///< backwards is where the laser does not look
  kBlockedZone,      ///< the border of a blocked zone is too near
  kObstacle          ///< what the laser sees, or could not see, is too near
};

[[nodiscard]] std::string_view name_of(StopReason reason);

/// Ends only when its cause is gone and a person has then said drive.
[[nodiscard]] bool waits_for_person(StopReason reason);

/// Whether the log tells when it begins: what befalls robot, laser or localizer, not what driving brings with it.
[[nodiscard]] bool is_told(StopReason reason);

}  // namespace deltamap::navigation
