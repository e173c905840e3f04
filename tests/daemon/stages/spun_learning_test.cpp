// SPDX-License-Identifier: Apache-2.0
// Wheels that spin tell nothing of how they err: after a robot that wanders in a room has spun for two seconds, what is
// kept of its wheels is as it was before, in virtual time.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "experiments/closed_loop/loop_run.hpp"
#include "experiments/closed_loop/virtual_daemon.hpp"
#include "simulation/scenario/start_map.hpp"
#include "tests/support/worlds/quiet_room.hpp"

namespace deltamap {
namespace {

using localization::motion::DriveCalibration;

constexpr Timestamp kSpinTrialStart = timestamp_from_ns(1'700'000'000'000'000'000);
constexpr double kLearnS = 60.0;  // of good driving
constexpr double kSpinS = 2.0;

/// The greatest change, in deviations of what was known before.
double changed(const DriveCalibration& from, const DriveCalibration& to) {
  const auto share = [](double before, double after, double deviation) { return std::abs(after - before) / deviation; };
  return std::max({share(from.wheels.distance, to.wheels.distance, from.wheel_deviations.distance),
                   share(from.wheels.turn, to.wheels.turn, from.wheel_deviations.turn),
                   share(from.wheels.drift_rad_per_m, to.wheels.drift_rad_per_m, from.wheel_deviations.drift_rad_per_m),
                   share(from.wheels.lag_s, to.wheels.lag_s, from.wheel_deviations.lag_s)});
}

experiments::LoopRun spinning(const std::string& fault, std::uint64_t seed) {
  experiments::LoopRun run;
  run.scenario = test::quiet_room();
  run.scenario.faults.push_back(simulation::fault_order(fault, experiments::kConnectS + kLearnS, kSpinS));
  run.settings = experiments::fitting(run.scenario);
  run.seed = seed;
  return run;
}

class SpunLearning : public testing::TestWithParam<std::string_view> {};

TEST_P(SpunLearning, IsForgottenWhetherTheyAreStoppedOrCreep) {
  constexpr double kHardlyChanged = 0.15;  // of a deviation: what two more ways of good driving do
  int contradicted = 0;
  for (const std::uint64_t seed : {1U, 2U, 3U, 4U, 5U}) {
    const experiments::LoopRun run = spinning(std::string(GetParam()), seed);
    simulation::Simulation world{run.scenario, {.seed = seed, .start = kSpinTrialStart, .change_every_s = {}}};
    const auto map = std::make_shared<const OccupancyGrid>(simulation::start_map(run.scenario, 0.05));
    experiments::VirtualDaemon daemon{world, {.settings = run.settings, .map = map}};
    daemon.start();
    daemon.run(experiments::kConnectS);
    ASSERT_TRUE(daemon.operator_says(true));
    daemon.run(kLearnS);
    ASSERT_TRUE(daemon.calibration());
    const DriveCalibration before = *daemon.calibration();
    daemon.run(kSpinS + 3.0);
    contradicted += daemon.last_allowed().stop == navigation::StopReason::kWheelsSpin ? 1 : 0;
    EXPECT_LT(changed(before, *daemon.calibration()), kHardlyChanged) << "kept, seed " << seed;
  }
  EXPECT_GE(contradicted, 3) << "the others creep: their scans have nothing in common with those before";
}

INSTANTIATE_TEST_SUITE_P(Each, SpunLearning, testing::Values("wheels-spin", "left-wheel-spins", "right-wheel-spins"),
                         [](const auto& trial) {
                           std::string name(trial.param);
                           std::replace(name.begin(), name.end(), '-', '_');
                           return name;
                         });

}  // namespace
}  // namespace deltamap
