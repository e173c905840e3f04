// SPDX-License-Identifier: Apache-2.0
#include "navigation/stop_reason.hpp"

namespace deltamap::navigation {

std::string_view name_of(StopReason reason) {
  switch (reason) {
    case StopReason::kNone:
      return "none";
    case StopReason::kNoCommand:
      return "no command";
    case StopReason::kCommandExpired:
      return "command expired";
    case StopReason::kNoOdometry:
      return "no odometry";
    case StopReason::kWatchdogUnknown:
      return "watchdog not known";
    case StopReason::kNoWatchdog:
      return "no watchdog";
    case StopReason::kStopButton:
      return "stop button";
    case StopReason::kMotorsOff:
      return "motors off";
    case StopReason::kBumper:
      return "bumper";
    case StopReason::kStalled:
      return "stalled";
    case StopReason::kControllerFault:
      return "controller fault";
    case StopReason::kLowBattery:
      return "low battery";
    case StopReason::kWheelsSpin:
      return "wheels turn and scans do not follow";
    case StopReason::kDisobeys:
      return "robot does not obey";
    case StopReason::kUnknownRobot:
      return "unknown robot";
    case StopReason::kCharging:
      return "charging";
    case StopReason::kNoBattery:
      return "no battery voltage";
    case StopReason::kStaleLaser:
      return "stale laser";
    case StopReason::kLaserBlind:
      return "laser sees nothing";
    case StopReason::kLaserFrozen:
      return "laser repeats one scan";
    case StopReason::kWayUncovered:
      return "way ahead not in the laser's view";
    case StopReason::kLaserError:
      return "laser error";
    case StopReason::kImplausible:
      return "implausible scan";
    case StopReason::kPoseUnknown:
      return "pose unknown";
    case StopReason::kLost:
      return "lost";
    case StopReason::kPoseWrong:
      return "pose wrong";
    case StopReason::kStartUnfit:
      return "start pose does not fit";
    case StopReason::kPoseUnsure:
      return "pose unsure";
    case StopReason::kPoseUnfit:
      return "scans do not fit the pose";
    case StopReason::kReverse:
      return "reverse refused";
    case StopReason::kObstacle:
      return "obstacle";
  }
  return "unknown";
}

bool waits_for_person(StopReason reason) {
  switch (reason) {
    case StopReason::kBumper:
    case StopReason::kStalled:
    case StopReason::kControllerFault:
    case StopReason::kLowBattery:
    case StopReason::kLaserError:
    case StopReason::kWheelsSpin:
    case StopReason::kDisobeys:
      return true;
    default:
      return false;
  }
}

bool is_told(StopReason reason) {
  switch (reason) {
    case StopReason::kNoWatchdog:
    case StopReason::kUnknownRobot:
    case StopReason::kCharging:
    case StopReason::kNoBattery:
    case StopReason::kLaserBlind:
    case StopReason::kLaserFrozen:
    case StopReason::kWayUncovered:
    case StopReason::kImplausible:
    case StopReason::kStartUnfit:
    case StopReason::kPoseUnsure:
    case StopReason::kPoseUnfit:
    case StopReason::kPoseUnknown:
    case StopReason::kLost:
    case StopReason::kPoseWrong:
      return true;
    default:
      return waits_for_person(reason);
  }
}

}  // namespace deltamap::navigation
