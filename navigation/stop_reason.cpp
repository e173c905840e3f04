// SPDX-License-Identifier: Apache-2.0
#include "navigation/stop_reason.hpp"

#include <array>
#include <cstddef>

namespace deltamap::navigation {
namespace {

struct NamedReason {
  StopReason reason;
  std::string_view name;
};

/// One row per reason, in the order of the enumeration.
constexpr auto kNames = std::to_array<NamedReason>({
    {StopReason::kNone, "none"},
    {StopReason::kNoCommand, "no command"},
    {StopReason::kCommandExpired, "command expired"},
    {StopReason::kNoOdometry, "no odometry"},
    {StopReason::kWatchdogUnknown, "watchdog not known"},
    {StopReason::kNoWatchdog, "no watchdog"},
    {StopReason::kStopButton, "stop button"},
    {StopReason::kMotorsOff, "motors off"},
    {StopReason::kBumper, "bumper"},
    {StopReason::kStalled, "stalled"},
    {StopReason::kControllerFault, "controller fault"},
    {StopReason::kLowBattery, "low battery"},
    {StopReason::kWheelsSpin, "wheels turn and scans do not follow"},
    {StopReason::kDisobeys, "robot does not obey"},
    {StopReason::kUnknownRobot, "unknown robot"},
    {StopReason::kCharging, "charging"},
    {StopReason::kNoBattery, "no battery voltage"},
    {StopReason::kStaleLaser, "stale laser"},
    {StopReason::kLaserBlind, "laser sees nothing"},
    {StopReason::kLaserFrozen, "laser repeats one scan"},
    {StopReason::kWayUncovered, "way ahead not in the laser's view"},
    {StopReason::kLaserError, "laser error"},
    {StopReason::kImplausible, "implausible scan"},
    {StopReason::kPoseUnknown, "pose unknown"},
    {StopReason::kLost, "lost"},
    {StopReason::kPoseWrong, "pose wrong"},
    {StopReason::kStartUnfit, "start pose does not fit"},
    {StopReason::kPoseUnsure, "pose unsure"},
    {StopReason::kPoseUnfit, "scans do not fit the pose"},
    {StopReason::kReverse, "reverse refused"},
    {StopReason::kBlockedZone, "blocked zone"},
    {StopReason::kObstacle, "obstacle"},
});

constexpr bool every_reason_has_its_row() {
  for (std::size_t row = 0; row < kNames.size(); ++row) {
    if (static_cast<std::size_t>(kNames[row].reason) != row) return false;
  }
  return kNames.back().reason == StopReason::kObstacle;
}
static_assert(every_reason_has_its_row(), "a reason has no name, or the rows are out of order");

}  // namespace

std::string_view name_of(StopReason reason) {
  const auto row = static_cast<std::size_t>(reason);
  return row < kNames.size() ? kNames[row].name : "unknown";
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
