// SPDX-License-Identifier: Apache-2.0
#include "simulation/changes/creep.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <map>

#include "simulation/scenario/scenario.hpp"
#include "simulation/simulation.hpp"
#include "simulation/virtual_drive.hpp"
#include "tests/support/files/source_tree.hpp"

namespace deltamap::simulation {
namespace {

const Circle kRobotOutside{{-100, -100}, 0.25};
constexpr double kSamePlace_m = 1e-9;

Scenario hall() { return read_scenario(test::source_path("config/scenarios/hall.yaml")); }

Creep creep_in(const Scenario& scenario, const CreepParams& params, std::uint64_t seed = 1) {
  return {params, scenario.world, scenario.robot.map_from_start.position(), Random{seed}};
}

TEST(Creep, PushesTheSameContainersInOneDirectionUntilTheirEnd) {
  const Scenario scenario = hall();
  Creep creep = creep_in(scenario, {.containers = 3, .step_m = 0.05, .times = 20});
  ASSERT_EQ(creep.containers(), 3u);
  World world = scenario.world;
  std::map<int, int> pushes;
  for (int turn = 0; turn < 25; ++turn) {
    for (const Change& push : creep.pushes(world, kRobotOutside, {})) {
      EXPECT_EQ(push.kind, ChangeKind::kCrept);
      EXPECT_NEAR((push.box.centre - push.from->centre).norm(), 0.05, kSamePlace_m);
      ++pushes[push.id];
      world = changed(world, push);
    }
  }
  ASSERT_EQ(pushes.size(), 3u);
  for (const auto& [id, count] : pushes) {
    EXPECT_EQ(count, 20);
    const Point2 way =
        std::get<Box>(world.find(id)->shape).centre - std::get<Box>(scenario.world.find(id)->shape).centre;
    EXPECT_NEAR(way.norm(), 1.0, kSamePlace_m) << "all pushes went one way";
  }
}

TEST(Creep, GoesTheWayThatItIsGiven) {
  const Scenario scenario = hall();
  Creep creep = creep_in(scenario, {.containers = 5, .direction_rad = radians(90)});
  const auto pushes = creep.pushes(scenario.world, kRobotOutside, {});
  ASSERT_EQ(pushes.size(), 5u);
  for (const Change& push : pushes) {
    EXPECT_NEAR(push.box.centre.x(), push.from->centre.x(), kSamePlace_m);
    EXPECT_NEAR(push.box.centre.y(), push.from->centre.y() + 0.05, kSamePlace_m);
  }
}

TEST(Creep, ChoosesOtherContainersForAnotherSeedAndTheSameForTheSame) {
  const Scenario scenario = hall();
  const auto first_ids = [&](std::uint64_t seed) {
    std::vector<int> ids;
    Creep creep = creep_in(scenario, {}, seed);
    for (const Change& push : creep.pushes(scenario.world, kRobotOutside, {})) ids.push_back(push.id);
    return ids;
  };
  EXPECT_EQ(first_ids(1), first_ids(1));
  EXPECT_NE(first_ids(1), first_ids(2));
}

TEST(Creep, PutsAPushOffWhileTheRobotOrSomeoneStandsThere) {
  const Scenario scenario = hall();
  Creep creep = creep_in(scenario, {.containers = 1, .times = 2});
  Creep undisturbed = creep;
  const Change push = undisturbed.pushes(scenario.world, kRobotOutside, {}).at(0);
  const Point2 onward = (push.box.centre - push.from->centre).normalized();
  const Circle beside{push.from->centre + (0.5 * push.from->width_m + 0.5) * onward, 0.25};
  EXPECT_TRUE(creep.pushes(scenario.world, beside, {}).empty());
  const std::vector<Circle> people{beside};
  EXPECT_TRUE(creep.pushes(scenario.world, kRobotOutside, people).empty());
  EXPECT_EQ(creep.pushes(scenario.world, kRobotOutside, {}).size(), 1u) << "later all the same";
}

TEST(Creep, NeverPushesIntoAnotherContainer) {
  Scenario scenario = hall();
  Creep creep = creep_in(scenario, {.containers = 8});
  World world = scenario.world;
  const Change first = creep.pushes(world, kRobotOutside, {}).at(0);
  const Point2 onward = (first.box.centre - first.from->centre).normalized();
  const Box in_the_way{first.from->centre + (first.from->width_m + 0.02) * onward, first.from->width_m,
                       first.from->height_m, 0.0};
  world = world.with({999, ObjectKind::kContainer, in_the_way});
  for (int turn = 0; turn < 3; ++turn) {
    for (const Change& push : creep.pushes(world, kRobotOutside, {})) EXPECT_NE(push.id, first.id);
  }
}

TEST(Creep, IsToldByTheLiveSimulatorAndByTheVirtualDrive) {
  Scenario scenario = read_scenario(test::source_path("config/scenarios/creep.yaml"));
  scenario.creep->every_s = 5.0;
  scenario.changed_at_start = ChangedStartParams{.share = 0.25};
  const Timestamp start = timestamp_from_ns(1'700'000'000'000'000'000);
  Simulation live{scenario, {3, start, std::nullopt}};
  live.advance_to(start + std::chrono::seconds{12});
  World rebuilt = scenario.world;
  std::map<ChangeKind, int> told;
  for (const TruthRecord& record : live.take_truth()) {
    const auto* change = std::get_if<TruthChange>(&record);
    if (change == nullptr) continue;
    ++told[change->change.kind];
    EXPECT_EQ(change->change.kind == ChangeKind::kCrept, change->time > start);
    rebuilt = changed(rebuilt, change->change);
  }
  EXPECT_EQ(told[ChangeKind::kCrept], 2 * scenario.creep->containers);
  EXPECT_GE(told[ChangeKind::kRemoved], 1);
  for (const Object& object : live.world().objects) ASSERT_NE(rebuilt.find(object.id), nullptr);
  EXPECT_EQ(rebuilt.objects.size(), live.world().objects.size());

  VirtualDrive drive{scenario, {.seed = 3, .creep = scenario.creep}};
  int crept = 0;
  for (int scan = 0; scan < 120; ++scan) {
    for (const Change& change : drive.next().changes) crept += change.kind == ChangeKind::kCrept ? 1 : 0;
  }
  EXPECT_EQ(crept, 2 * scenario.creep->containers);
}

}  // namespace
}  // namespace deltamap::simulation
