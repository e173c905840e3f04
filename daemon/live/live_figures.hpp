// SPDX-License-Identifier: Apache-2.0
// What a run costs and what it has learned of the robot, for the live page's charts.
#pragma once

#include <array>
#include <cstddef>
#include <limits>

#include "daemon/telemetry/stage.hpp"
#include "daemon/telemetry/telemetry.hpp"

namespace deltamap::daemon {

/// NaN: not known.
struct LiveFigures {
  static constexpr std::size_t kStages = 6;  ///< io, localization, delta, map, recorder, page
  static constexpr double kUnknown = std::numeric_limits<double>::quiet_NaN();
  std::array<double, kStages> cpu_s{kUnknown, kUnknown, kUnknown, kUnknown, kUnknown, kUnknown};  ///< since their start
  double resident_bytes = kUnknown;
  double wheel_distance = kUnknown;  ///< share driven beyond what the wheels count
  double wheel_turn = kUnknown;      ///< share turned beyond what the wheels count
};

/// In the order of LiveFigures::cpu_s. They outlive whoever asks.
using WatchedStages = std::array<const Stage*, LiveFigures::kStages>;

/// As they are now. Any thread.
[[nodiscard]] LiveFigures figures_of(const WatchedStages& stages, const Telemetry& telemetry);

}  // namespace deltamap::daemon
