// SPDX-License-Identifier: Apache-2.0
#include "simulation/changes/forklift.hpp"

#include <gtest/gtest.h>

#include <string>

#include "simulation/scenario/scenario.hpp"
#include "tests/support/files/source_tree.hpp"

namespace deltamap::simulation {
namespace {

Scenario delivered(const std::string& name) {
  return read_scenario(test::source_path("config/scenarios/") + name + ".yaml");
}

struct History {
  std::vector<Change> changes;
  World world;
};

/// The robot and one person jump about on free floor between the changes.
History run(const Scenario& scenario, std::uint64_t seed, int changes) {
  Random random{seed};
  History result{{}, scenario.world};
  const Point2 start = scenario.robot.map_from_start.position();
  Forklift lift{*scenario.forklift, scenario.slots, scenario.world, start, Random{seed}};
  const auto somewhere = [&](double radius_m) {
    const ReachableFloor floor = reachable_floor(result.world, start, 0.5);
    for (;;) {
      const Cell cell{static_cast<int>(random.index_below(static_cast<std::uint32_t>(floor.geometry.width))),
                      static_cast<int>(random.index_below(static_cast<std::uint32_t>(floor.geometry.height)))};
      if (floor.contains(floor.geometry.centre_of(cell))) return Circle{floor.geometry.centre_of(cell), radius_m};
    }
  };
  for (int i = 0; i < changes; ++i) {
    const Circle robot = somewhere(0.25);
    const std::vector<Circle> people{somewhere(0.2)};
    const auto change = lift.next_change(result.world, robot, people);
    if (!change) continue;
    EXPECT_GE(distance_between(robot.centre, change->box), 0.25 + 1.0);
    EXPECT_GE(distance_between(people[0].centre, change->box), 0.2 + 0.5);
    if (change->from) {
      EXPECT_GE(distance_between(robot.centre, *change->from), 0.25 + 1.0);
    }
    result.world = changed(result.world, *change);
    // Someone of the robot's size still reaches the four corners' neighbourhood: nothing is walled up.
    EXPECT_GE(share_still_reached(reachable_floor(scenario.world, start, 0.5 * scenario.forklift->passage_m),
                                  reachable_floor(result.world, robot.centre, 0.5 * scenario.forklift->passage_m)),
              0.9);
    result.changes.push_back(*change);
  }
  return result;
}

TEST(Forklift, KeepsItsMarginsAndThePassagesInEveryScenario) {
  for (const char* name : {"hall", "hall_shifts", "room", "demo"}) {
    const History done = run(delivered(name), 7, 60);
    EXPECT_GT(done.changes.size(), 30u) << name << ": most turns find something to do";
  }
}

TEST(Forklift, DoesTheSameFromTheSameSeedAndAnotherThingFromAnother) {
  const Scenario scenario = delivered("demo");
  const auto ids = [](const History& done) {
    std::vector<int> all;
    for (const Change& change : done.changes) all.push_back(change.id);
    return all;
  };
  EXPECT_EQ(ids(run(scenario, 1, 40)), ids(run(scenario, 1, 40)));
  EXPECT_NE(ids(run(scenario, 1, 40)), ids(run(scenario, 2, 40)));
}

TEST(Forklift, NeverLetsContainersShareTheirPlace) {
  const History done = run(delivered("demo"), 3, 80);
  for (const Object& a : done.world.objects) {
    const Box* box = std::get_if<Box>(&a.shape);
    if (box == nullptr || a.kind != ObjectKind::kContainer) continue;
    for (const Object& b : done.world.objects) {
      if (a.id != b.id) {
        EXPECT_FALSE(overlap(grown(*box, -0.002), b.shape)) << a.id << " and " << b.id;
      }
    }
  }
}

TEST(Forklift, ShiftsNoFartherThanItMay) {
  const Scenario scenario = delivered("hall_shifts");
  for (const Change& change : run(scenario, 5, 50).changes) {
    ASSERT_EQ(change.kind, ChangeKind::kShifted);
    const double shift_m = (change.box.centre - change.from->centre).norm();
    EXPECT_GE(shift_m, 0.3);
    EXPECT_LE(shift_m, 0.8);
  }
}

TEST(Forklift, DoesAllKindsOfChangesInTheDemo) {
  int kinds[3] = {0, 0, 0};
  for (const Change& change : run(delivered("demo"), 1, 60).changes) ++kinds[static_cast<int>(change.kind)];
  for (const int count : kinds) EXPECT_GT(count, 5);
}

}  // namespace
}  // namespace deltamap::simulation
