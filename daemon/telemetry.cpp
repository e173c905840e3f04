// SPDX-License-Identifier: Apache-2.0
#include "daemon/telemetry.hpp"

#include <cinttypes>
#include <cstdio>

#include "core/angle.hpp"

namespace deltamap::daemon {
namespace {

const char* up(const Gauge<bool>& device) { return device.value() ? "up" : "--"; }

}  // namespace

std::string_view name_of(LocalizerState state) {
  switch (state) {
    case LocalizerState::kGlobal:
      return "global";
    case LocalizerState::kTracking:
      return "tracking";
    case LocalizerState::kLost:
      return "lost";
  }
  return "";
}

std::string status_line(const Telemetry& t) {
  const auto state = name_of(static_cast<LocalizerState>(t.state.value()));
  const std::uint64_t drops = t.odometry_lost.value() + t.scans_lost.value() + t.dropped.value() +
                              t.tracked_lost.value() + t.sets_lost.value() + t.recording_lost.value();
  char line[320];
  const int length = std::snprintf(
      line, sizeof line,
      "robot=%s laser=%s scans=%" PRIu64 " %.*s x=%.2f y=%.2f heading=%.0f n_eff=%.0f/%" PRIu32
      " w_avg=%.3f map=%" PRIu32 " refused=%" PRIu32 " phase=%" PRIu32 "%s drops=%" PRIu64 " latency_ms=%.1f",
      up(t.robot_up), up(t.laser_up), t.scans.value(), static_cast<int>(state.size()), state.data(), t.x_m.value(),
      t.y_m.value(), degrees(t.heading_rad.value()), t.n_eff.value(), t.particles.value(), t.w_avg.value(),
      t.revision.value(), t.refused.value(), t.phase.value(), t.in_phase.value() ? "*" : "", drops,
      t.latency_s.value() * 1e3);
  return {line, static_cast<std::size_t>(length)};
}

}  // namespace deltamap::daemon
