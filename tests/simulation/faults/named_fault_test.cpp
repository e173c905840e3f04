// SPDX-License-Identifier: Apache-2.0
// Faults by their names: how they are ordered, begin and end.
#include "simulation/faults/named_fault.hpp"

#include <gtest/gtest.h>

#include <algorithm>

#include "tests/simulation/simulation_host.hpp"

namespace deltamap::simulation {
namespace {

bool is_blind(const Scan& scan) {
  return std::all_of(scan.beams.begin(), scan.beams.end(),
                     [](const Beam& beam) { return beam.kind == BeamKind::kBeyondMaximum; });
}

TEST(NamedFaults, SetSomethingAndClearAllOfIt) {
  for (const NamedFault& fault : named_faults()) {
    Faults faults;
    fault.set(faults, fault.usual);
    EXPECT_NE(faults, Faults{}) << fault.name;
    if (fault.is_momentary()) continue;
    fault.clear(faults);
    // The number of an answer that is not given is of no meaning.
    faults.laser.constant_m = LaserFaults{}.constant_m;
    faults.laser.random_most_m = LaserFaults{}.random_most_m;
    EXPECT_EQ(faults, Faults{}) << fault.name;
    EXPECT_TRUE(fault.unit.empty() || (fault.usual >= fault.least && fault.usual <= fault.most)) << fault.name;
  }
}

TEST(NamedFaults, AreReadWithTheirNumbersOrRefusedInOneLine) {
  EXPECT_EQ(described(fault_order("laser-constant=2.5", 20.0, 10.0)), "laser-constant=2.5 from 20 s for 10 s");
  EXPECT_EQ(described(fault_order("laser-turned")), "laser-turned=180 from 0 s");
  EXPECT_EQ(described(fault_order("laser-repeats", 3.5)), "laser-repeats from 3.5 s");
  EXPECT_EQ(described(fault_order("20:laser-constant:2.5:10")), "laser-constant=2.5 from 20 s for 10 s");
  EXPECT_EQ(described(fault_order("1.5:laser-constant=2.5:10", 2.0)), "laser-constant=2.5 from 3.5 s for 10 s");
  EXPECT_EQ(described(fault_order("laser-constant::10")), "laser-constant=5 from 0 s for 10 s");
  EXPECT_EQ(described(fault_order("7:laser-repeats:3", 0.0, 9.0)), "laser-repeats from 7 s for 3 s");
  EXPECT_EQ(described(fault_order("4:laser-restarts:60")), "laser-restarts=60 at 4 s");
  for (const char* wrong :
       {"laser-dances", "", "laser-repeats=1", "laser-constant=", "laser-constant=x", "laser-constant=1e9",
        "laser-constant=2.5 m", "goes-at=nan", "-1:laser-repeats", "5:", "laser-repeats:0", "laser-repeats:3:4",
        "laser-constant:2:3:4", "robot-restarts:5", "inf:laser-repeats"}) {
    EXPECT_THROW((void)fault_order(wrong), std::invalid_argument) << wrong;
  }
}

TEST(NamedFaults, AreAllNamedInTheHelp) {
  const std::string help = fault_help();
  for (const NamedFault& fault : named_faults())
    EXPECT_NE(help.find("  " + std::string(fault.name) + " "), std::string::npos) << fault.name;
  EXPECT_NE(help.find("a number from 0.02 to 80 (m), usually 5\n"), std::string::npos);
}

TEST(NamedFaults, EndByNameOrAllAndThoseThatWaitNeverBegin) {
  Faults faults;
  FaultSchedule schedule{{fault_order("laser-repeats"), fault_order("stop-button"), fault_order("5:stop-button"),
                          fault_order("robot-restarts")}};
  schedule.apply(0.0, faults);
  EXPECT_EQ(faults.controller.resets, 1);
  EXPECT_TRUE(faults.controller.stop_button);
  EXPECT_EQ(schedule.orders().size(), 3u) << "what is over in a moment is over";
  EXPECT_EQ(schedule.end("stop-button", faults), 2u);
  EXPECT_FALSE(faults.controller.stop_button);
  schedule.apply(6.0, faults);
  EXPECT_FALSE(faults.controller.stop_button);
  EXPECT_EQ(schedule.end({}, faults), 1u);
  EXPECT_EQ(faults.laser, LaserFaults{});
}

TEST(NamedFaults, BeginAndEndAtTheTimesOfAScenario) {
  Scenario scenario = parse_scenario(
      "walls:\n  - [[0, 0], [20, 0], [20, 10], [0, 10], [0, 0]]\nrobot: {start: [5, 4, 0]}\n"
      "faults:\n  - {fault: laser-beyond-maximum, after_s: 14, for_s: 3}\n  - {fault: battery=0, after_s: 20}\n",
      "hall");
  Host host{scenario, 1};
  host.run_for(13.5);
  EXPECT_FALSE(is_blind(host.scans.back()));
  host.run_for(2.5);
  EXPECT_TRUE(is_blind(host.scans.back()));
  host.run_for(3.0);
  EXPECT_FALSE(is_blind(host.scans.back()));
  EXPECT_GT(host.odometry.back().battery_v, 10.0);
  host.run_for(2.0);
  EXPECT_EQ(host.odometry.back().battery_v, 0.0);
  EXPECT_THROW(
      (void)parse_scenario("robot: {start: [0, 0, 0]}\nfaults:\n  - {fault: robot-restarts, for_s: 3}\n", "hall"),
      std::runtime_error);
  EXPECT_THROW((void)parse_scenario("robot: {start: [0, 0, 0]}\nfaults:\n  - {fault: laser-dances}\n", "hall"),
               std::runtime_error);
}

}  // namespace
}  // namespace deltamap::simulation
