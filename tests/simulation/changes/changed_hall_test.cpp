// SPDX-License-Identifier: Apache-2.0
#include "simulation/changes/changed_hall.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <set>

#include "simulation/scenario/start_map.hpp"
#include "simulation/virtual_drive.hpp"
#include "tests/support/files/source_tree.hpp"

namespace deltamap::simulation {
namespace {

Scenario named(const std::string& name) {
  return read_scenario(test::source_path("config/scenarios/") + name + ".yaml");
}

bool stands_at(const World& world, const Box& slot) {
  return std::any_of(world.objects.begin(), world.objects.end(), [&](const Object& object) {
    const Box* box = std::get_if<Box>(&object.shape);
    return box != nullptr && (box->centre - slot.centre).norm() < 0.01;
  });
}

double share_changed(const Scenario& scenario, const World& now) {
  const auto differs = [&](const Box& slot) { return stands_at(now, slot) != stands_at(scenario.world, slot); };
  return static_cast<double>(std::count_if(scenario.slots.begin(), scenario.slots.end(), differs)) /
         static_cast<double>(scenario.slots.size());
}

ChangedHall start_of(const Scenario& scenario, double share, std::uint64_t seed) {
  return changed_start({.share = share}, scenario.slots, scenario.world,
                       {scenario.robot.map_from_start.position(), 0.25}, {}, Random{seed});
}

TEST(ChangedHall, BeginsWithAQuarterHalfOrThreeQuartersOfTheSlotsChanged) {
  for (const char* name : {"hall", "depot"}) {
    const Scenario scenario = named(name);
    for (const double share : {0.25, 0.5, 0.75}) {
      for (const std::uint64_t seed : {1u, 2u, 3u}) {
        const double reached = share_changed(scenario, start_of(scenario, share, seed).world);
        EXPECT_NEAR(reached, share, 0.02) << name << " seed " << seed;
      }
    }
  }
}

TEST(ChangedHall, TellsEachContainerThatDiffersOnceAndTheyMakeTheWorld) {
  const Scenario scenario = named("hall");
  const ChangedHall hall = start_of(scenario, 0.5, 4);
  World rebuilt = scenario.world;
  std::set<int> ids;
  for (const Change& change : hall.changes) {
    EXPECT_TRUE(ids.insert(change.id).second) << change.id << " changed twice";
    EXPECT_FALSE(change.kind == ChangeKind::kAdded && stands_at(scenario.world, change.box));
    rebuilt = changed(rebuilt, change);
  }
  ASSERT_EQ(rebuilt.objects.size(), hall.world.objects.size());
  for (const Object& object : hall.world.objects) {
    const Object* same = rebuilt.find(object.id);
    ASSERT_NE(same, nullptr);
    if (const Box* box = std::get_if<Box>(&object.shape)) {
      EXPECT_EQ(std::get<Box>(same->shape).centre, box->centre);
    }
  }
}

TEST(ChangedHall, IsWhereAVirtualDriveBeginsWhileTheFirstMapIsOfTheWorldBefore) {
  Scenario scenario = named("hall");
  VirtualDrive as_before{scenario, {.seed = 2}};
  VirtualDrive changed{scenario, {.seed = 2, .changed_at_start = ChangedStartParams{.share = 0.5}}};
  EXPECT_EQ(share_changed(scenario, as_before.world()), 0.0);
  EXPECT_EQ(share_changed(scenario, changed.world()), 0.5);
  EXPECT_FALSE(changed.next().changes.empty()) << "the first scan shows them";
  EXPECT_TRUE(changed.next().changes.empty());
  scenario.changed_at_start = ChangedStartParams{.share = 0.25};
  EXPECT_EQ(share_changed(scenario, VirtualDrive(scenario, {}).world()), 0.25) << "or as the scenario says";
}

TEST(ChangedHall, LetsTheForkLiftWorkOnInIt) {
  const Scenario scenario = named("hall");
  VirtualDriveParams params;
  params.changed_at_start = ChangedStartParams{.share = 0.5};
  params.forklift = ForkliftParams{.change_every_s = 2.0};
  VirtualDrive drive{scenario, params};
  std::set<int> standing;
  for (const Object& object : drive.world().objects) standing.insert(object.id);
  (void)drive.next();
  int changes = 0;
  for (int scan = 0; scan < 1000; ++scan) {
    for (const Change& change : drive.next().changes) {
      ++changes;
      if (change.kind == ChangeKind::kAdded) {
        EXPECT_TRUE(standing.insert(change.id).second) << "a container that stands already came anew";
      } else {
        EXPECT_EQ(standing.erase(change.id), 1u) << "took what was not there";
      }
    }
  }
  EXPECT_GT(changes, 20);
}

}  // namespace
}  // namespace deltamap::simulation
