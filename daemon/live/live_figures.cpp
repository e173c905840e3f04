// SPDX-License-Identifier: Apache-2.0
#include "daemon/live/live_figures.hpp"

#include "daemon/system/used_memory.hpp"

namespace deltamap::daemon {

LiveFigures figures_of(const WatchedStages& stages, const Telemetry& telemetry) {
  LiveFigures figures;
  for (std::size_t i = 0; i < stages.size(); ++i) {
    if (stages[i] != nullptr) figures.cpu_s[i] = stages[i]->cpu_now_s().value_or(LiveFigures::kUnknown);
  }
  if (const std::uint64_t bytes = resident_bytes(); bytes > 0) figures.resident_bytes = static_cast<double>(bytes);
  if (const auto calibration = telemetry.calibration.get()) {
    figures.wheel_distance = calibration->wheels.distance;
    figures.wheel_turn = calibration->wheels.turn;
  }
  return figures;
}

}  // namespace deltamap::daemon
