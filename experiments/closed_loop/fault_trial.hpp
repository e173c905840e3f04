// SPDX-License-Identifier: Apache-2.0
// What goes wrong in a trial, with the devices, the mount or the robot, and a drive in which it does.
#pragma once

#include <array>
#include <string>
#include <string_view>

#include "experiments/closed_loop/loop_run.hpp"

namespace deltamap::experiments {

/// By the names of simulation/faults; or a mount that is told to look back.
inline constexpr std::array<std::string_view, 30> kTrialFaults{"laser-repeats",
                                                               "laser-constant=5",
                                                               "laser-constant=2",
                                                               "laser-random=10",
                                                               "laser-beyond-maximum",
                                                               "laser-not-valid",
                                                               "laser-dazzled",
                                                               "laser-turned=180",
                                                               "laser-turned=90",
                                                               "laser-turned=-90",
                                                               "laser-turned=45",
                                                               "laser-upside-down",
                                                               "laser-covered-ahead=60",
                                                               "laser-covered-ahead=120",
                                                               "laser-covered-left=90",
                                                               "laser-covered-right=90",
                                                               "laser-stands",
                                                               "laser-elsewhere=3",
                                                               "wheels-spin",
                                                               "left-wheel-spins",
                                                               "right-wheel-spins",
                                                               "wheels-blocked",
                                                               "towed=0.3",
                                                               "keeps-set-points",
                                                               "goes-at=0.4",
                                                               "turns-at=40",
                                                               "speed-factor=2",
                                                               "charger-plugged",
                                                               "battery=0",
                                                               "mount-turned=180"};

struct FaultTrial {
  std::string fault;       ///< one of kTrialFaults
  double before_s = 20.0;  ///< of driving until it goes wrong; 0: it is wrong from the start
  double for_s = 60.0;     ///< after that
  std::uint64_t seed = 1;
};

/// `settings` are made to fit the scenario.
[[nodiscard]] LoopRun run_of(const FaultTrial& trial, const simulation::Scenario& scenario,
                             const daemon::Settings& settings);

}  // namespace deltamap::experiments
