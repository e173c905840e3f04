// SPDX-License-Identifier: Apache-2.0
#include "daemon/incidents/incident_watch.hpp"

#include <cmath>
#include <string>
#include <utility>

namespace deltamap::daemon {
namespace {

using navigation::StopReason;

constexpr double kPauseS = 10.0;  // without a scan: what is not known behind it was not lost by the localizer

constexpr double kSilentS = 1.0;  // a change of the line speed takes less

std::string with_trouble(std::string words, const std::string& trouble) {
  return trouble.empty() ? words : std::move(words) + ": " + trouble;
}

}  // namespace

std::optional<IncidentEvent> PoseWatch::observe(const LocalizationRow& row) {
  const auto before = std::exchange(state_, row.state);
  const double pause_s = seconds(row.time - std::exchange(time_, row.time));
  if (before != LocalizerState::kTracking || row.state == LocalizerState::kTracking) return std::nullopt;
  if (row.state == LocalizerState::kLost)
    return IncidentEvent{IncidentKind::kLost, row.time, "the pose was lost: the scans speak against it"};
  if (pause_s > kPauseS) {
    return IncidentEvent{IncidentKind::kLost, row.time,
                         "the pose is in doubt after " + std::to_string(std::lround(pause_s)) + " s without a scan"};
  }
  return IncidentEvent{IncidentKind::kKidnapped, row.time,
                       "the robot is elsewhere than it believed: another pose has won"};
}

std::optional<IncidentKind> kind_of(StopReason reason) {
  switch (reason) {
    case StopReason::kStopButton:
    case StopReason::kBumper:
    case StopReason::kStalled:
    case StopReason::kWheelsSpin:
    case StopReason::kDisobeys:
    case StopReason::kPoseWrong:
    case StopReason::kPoseUnfit:
      return IncidentKind::kSafetyStop;
    case StopReason::kControllerFault:
    case StopReason::kLowBattery:
    case StopReason::kLaserBlind:
    case StopReason::kLaserFrozen:
    case StopReason::kLaserError:
    case StopReason::kImplausible:
      return IncidentKind::kDeviceFault;
    default:
      return std::nullopt;
  }
}

std::vector<IncidentEvent> RunWatch::observe(const Telemetry& telemetry, Timestamp now) {
  std::vector<IncidentEvent> events;
  watch_devices(telemetry, now, events);
  watch_stops(telemetry, now, events);
  watch_map(telemetry, now, events);
  return events;
}

void RunWatch::watch_devices(const Telemetry& telemetry, Timestamp now, std::vector<IncidentEvent>& events) {
  const auto watch = [&](std::optional<Timestamp>& up, bool is_up, const char* words, const Notice& trouble) {
    if (is_up) {
      up = now;
    } else if (up && seconds(now - *up) > kSilentS) {
      events.push_back(
          {IncidentKind::kDeviceFault, *std::exchange(up, std::nullopt), with_trouble(words, trouble.line())});
    }
  };
  watch(robot_up_, telemetry.robot_up.value(), "the robot has fallen silent", telemetry.robot_trouble);
  watch(laser_up_, telemetry.laser_up.value(), "the laser has fallen silent", telemetry.laser_trouble);
}

/// What forbids to drive is told once, by whichever shows it first.
void RunWatch::watch_stops(const Telemetry& telemetry, Timestamp now, std::vector<IncidentEvent>& events) {
  const auto watch = [&](StopReason& told, StopReason other, std::uint8_t value) {
    const auto reason = static_cast<StopReason>(value);
    const auto kind = kind_of(reason);
    const bool is_new = std::exchange(told, kind ? reason : StopReason::kNone) != reason;
    if (kind && is_new && reason != other)
      events.push_back({*kind, now, "driving is stopped: " + std::string(navigation::name_of(reason))});
  };
  watch(stop_, unfit_, telemetry.stop_reason.value());
  watch(unfit_, stop_, telemetry.unfit.value());
}

void RunWatch::watch_map(const Telemetry& telemetry, Timestamp now, std::vector<IncidentEvent>& events) {
  const std::uint32_t revision = telemetry.newest_revision.value();
  const std::uint32_t refused = telemetry.stale_refusals.value();
  if (revision_ != revision) {
    revision_ = revision;
    refused_before_ = refused;
    streak_is_told_ = false;
  }
  const std::uint32_t streak = refused - refused_before_;
  if (streak < kRefusals || std::exchange(streak_is_told_, true)) return;
  events.push_back(
      {IncidentKind::kRefusals, now, std::to_string(streak) + " updates of the map were refused one after another"});
}

}  // namespace deltamap::daemon
