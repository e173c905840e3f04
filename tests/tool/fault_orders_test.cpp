// SPDX-License-Identifier: Apache-2.0
// Orders on the standard input of `deltamap sim`.
#include "tool/fault_orders.hpp"

#include <gtest/gtest.h>
#include <unistd.h>

#include <array>

#include "tests/support/files/source_tree.hpp"

namespace deltamap::tool {
namespace {

simulation::Simulation room() {
  return simulation::Simulation{simulation::read_scenario(test::source_path("config/scenarios/room.yaml")),
                                {1, timestamp_from_ns(1'700'000'000'000'000'000), std::nullopt}};
}
void let_pass(simulation::Simulation& devices, double time_s) {
  devices.advance_to(devices.now() + duration_from_seconds(time_s));
}

TEST(FaultOrders, BeginNowOrLaterAndEndByTheirTimeOrByName) {
  simulation::Simulation devices = room();
  let_pass(devices, 2.0);
  EXPECT_TRUE(obeyed(" laser-repeats:1\r", devices).starts_with("fault laser-repeats from 2 s for 1 s: "));
  EXPECT_TRUE(obeyed("1.5:battery:9", devices).starts_with("fault battery=9 from 3.5 s: "));
  let_pass(devices, 0.5);
  EXPECT_EQ(devices.faults().laser.answer, simulation::LaserFaults::Answer::kRepeated);
  EXPECT_EQ(devices.faults().controller.battery_v, std::nullopt);
  let_pass(devices, 1.5);
  EXPECT_EQ(devices.faults().laser.answer, simulation::LaserFaults::Answer::kMeasured);
  EXPECT_EQ(devices.faults().controller.battery_v, 9.0);
  EXPECT_TRUE(obeyed("list", devices).starts_with("fault battery=9 from 3.5 s: "));
  EXPECT_EQ(obeyed("end battery", devices), "ended faults=1\n");
  EXPECT_EQ(devices.faults().controller.battery_v, std::nullopt);
  EXPECT_EQ(obeyed("list", devices), "no faults\n");
}

TEST(FaultOrders, TellWhatTheyDoNotUnderstand) {
  simulation::Simulation devices = room();
  EXPECT_EQ(obeyed("", devices), "");
  EXPECT_TRUE(obeyed("dance", devices).starts_with("fault \"dance\" is unknown: one of "));
  EXPECT_TRUE(obeyed("end dance", devices).starts_with("no fault \"dance\" was ordered"));
  EXPECT_NE(obeyed("help", devices).find("\n  laser-repeats "), std::string::npos);
}

TEST(OrderLines, AreReadWholeHoweverTheyComeAndNeverWaitedFor) {
  std::array<int, 2> ends{};
  ASSERT_EQ(::pipe(ends.data()), 0);
  OrderLines lines{ends[0]};
  EXPECT_TRUE(lines.read().empty());
  ASSERT_EQ(::write(ends[1], "one\ntw", 6), 6);
  EXPECT_EQ(lines.read(), std::vector<std::string>{"one"});
  ASSERT_EQ(::write(ends[1], "o\n", 2), 2);
  EXPECT_EQ(lines.read(), std::vector<std::string>{"two"});
  std::vector<pollfd> watched;
  lines.watch(watched);
  EXPECT_EQ(watched.size(), 1u);
  ::close(ends[1]);
  EXPECT_TRUE(lines.read().empty());
  watched.clear();
  lines.watch(watched);
  EXPECT_TRUE(watched.empty()) << "an end would wake it again and again";
  ::close(ends[0]);
}

}  // namespace
}  // namespace deltamap::tool
