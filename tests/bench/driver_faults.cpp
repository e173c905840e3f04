// SPDX-License-Identifier: Apache-2.0
// Drives in which one thing after another goes wrong with lines, devices and people's hands, for ./dev bench faults:
//   driver_faults SCENARIO.yaml RUNS [FIRST-SEED [FAULT]]
// A JSON line for each fault and for each drive.
#include <cstdio>
#include <cstdlib>
#include <mutex>
#include <nlohmann/json.hpp>
#include <thread>
#include <vector>

#include "core/work_pool.hpp"
#include "experiments/closed_loop/driver_trial.hpp"

namespace deltamap::experiments {
namespace {

void tell(const nlohmann::json& line) { std::printf("%s\n", line.dump().c_str()); }

void tell(std::uint64_t seed, const DriverTrialOutcome& outcome) {
  for (const TriedDriverFault& fault : outcome.faults) {
    tell({{"seed", seed},
          {"fault", fault.name},
          {"order", fault.order},
          {"begins_s", fault.begins_s},
          {"back_after_s", fault.back_after_s},
          {"is_back_soon", fault.is_back_soon},
          {"lasted_s", fault.lasted_s},
          {"lines", fault.lines}});
  }
  tell({{"seed", seed},
        {"wrong_frames", outcome.wrong_frames},
        {"wrong_scans", outcome.wrong_scans},
        {"collisions", outcome.collisions},
        {"forbidden", outcome.forbidden},
        {"moved_m", outcome.moved_m}});
}

int play(const char* scenario_file, std::size_t runs, std::uint64_t first_seed, const char* only) {
  const simulation::Scenario scenario = simulation::read_scenario(scenario_file);
  const std::vector<std::string_view> faults = only != nullptr ? std::vector<std::string_view>{only} : driver_faults();
  std::mutex output;
  const auto drive = [&](std::size_t run) {
    const std::uint64_t seed = first_seed + run;
    const DriverTrialOutcome outcome = outcome_of({seed, 60.0, faults}, scenario, {});
    const std::scoped_lock lock{output};
    tell(seed, outcome);
  };
  work_through(runs, static_cast<int>(std::max(1u, std::thread::hardware_concurrency())), drive, [](std::size_t) {});
  return 0;
}

}  // namespace
}  // namespace deltamap::experiments

int main(int count, char** words) {
  if (count < 3) return 2;
  const auto number = [&](int at, std::uint64_t otherwise) {
    return count > at ? std::strtoull(words[at], nullptr, 10) : otherwise;
  };
  return deltamap::experiments::play(words[1], number(2, 1), number(3, 1), count > 4 ? words[4] : nullptr);
}
