// SPDX-License-Identifier: Apache-2.0
#include "simulation/scenario/scenario.hpp"
#include "tests/support/files/source_tree.hpp"

#include <gtest/gtest.h>

#include <filesystem>
#include <stdexcept>
#include <string>

namespace deltamap::simulation {
namespace {

const std::string kRoom = "walls:\n  - [[0, 0], [10, 0], [10, 4], [0, 4], [0, 0]]\nrobot:\n  start: [1, 2, 90]\n";

std::string complaint_of(const std::string& yaml) {
  try {
    (void)parse_scenario(yaml, "world.yaml");
  } catch (const std::runtime_error& error) {
    return error.what();
  }
  return "none";
}

TEST(Scenario, ReadsWallsBlocksPostsRobotAndPeople) {
  const Scenario scenario =
      parse_scenario(kRoom +
                         "blocks:\n  - {corner: [4, 1], columns: 2, rows: 3, size: [0.3, 0.4], empty: [[1, 2]]}\n"
                         "posts:\n  - circle: [8, 2, 0.1]\n"
                         "people:\n  - path: [[2, 1], [3, 1]]\n",
                     "world.yaml");
  EXPECT_EQ(scenario.slots.size(), 6u);
  EXPECT_EQ(scenario.world.objects.size(), 1u + 5u + 1u);
  EXPECT_NEAR(scenario.slots[0].centre.x(), 4.15, 1e-12);
  EXPECT_NEAR(scenario.robot.map_from_start.theta, radians(90), 1e-12);
  EXPECT_EQ(scenario.people.size(), 1u);
  EXPECT_FALSE(scenario.forklift);
}

TEST(Scenario, RefusesWhatNobodyReadsWithFileLineAndKey) {
  EXPECT_EQ(complaint_of(kRoom + "wals: []\n"), "world.yaml: line 5: 'wals' is not a key of 'the scenario'");
  EXPECT_EQ(complaint_of(kRoom + "forklift:\n  every: 3\n"), "world.yaml: line 6: 'every' is not a key of 'forklift'");
}

TEST(Scenario, RefusesWrongTypesAndRangesWithTheirLine) {
  EXPECT_EQ(complaint_of(kRoom + "forklift:\n  change_every_s: soon\n"),
            "world.yaml: line 6: 'change_every_s' must be a number");
  EXPECT_EQ(complaint_of(kRoom + "laser:\n  units: inch\n"), "world.yaml: line 6: 'units' must be cm or mm");
  EXPECT_EQ(complaint_of(kRoom + "laser:\n  baud: 12345\n"),
            "world.yaml: line 6: 'baud' must be one of 9600, 19200, 38400, 500000");
  EXPECT_EQ(complaint_of(kRoom + "posts:\n  - circle: [1, 2]\n"),
            "world.yaml: line 6: 'circle' must be a list of 3 numbers");
  EXPECT_EQ(complaint_of("walls:\n  - [[0, 0], [10, 0]]\nrobot:\n  start: [1, 0.1, 0]\n"),
            "world.yaml: line 4: 'start' puts the robot into a wall, a container or a post");
  EXPECT_EQ(complaint_of(""), "world.yaml: line 1: not a scenario (expected 'walls', 'robot', ...)");
  EXPECT_EQ(complaint_of("walls: [\n"), "world.yaml: line 1: not YAML: a '[' is not closed");
}

TEST(Scenario, ReadsRacksGlassAndWrappedPallets) {
  const Scenario scenario =
      parse_scenario(kRoom +
                         "racks:\n  - {corner: [3, 1, 90], pitch: [1, 0.5], columns: 2, rows: 3}\n"
                         "  - {corner: [8, 1, 0], pitch: [1, 1], columns: 2, round: true}\n"
                         "glass:\n  - {line: [[5, 0], [5, 4]], drawn: false}\n"
                         "wrapped:\n  - [6.5, 2, 1.2, 0.8, 0]\n",
                     "world.yaml");
  const auto& objects = scenario.world.objects;
  ASSERT_EQ(objects.size(), 1u + 6u + 2u + 1u + 1u);
  const Box last_of_first_rack = std::get<Box>(objects[6].shape);
  EXPECT_NEAR(last_of_first_rack.centre.x(), 3.0 - 2 * 0.5, 1e-12);
  EXPECT_NEAR(last_of_first_rack.centre.y(), 1.0 + 1.0, 1e-12);
  EXPECT_EQ(last_of_first_rack.width_m, 0.08);
  EXPECT_EQ(std::get<Circle>(objects[7].shape).radius_m, 0.04);
  EXPECT_EQ(objects[9].material, Material::kGlass);
  EXPECT_FALSE(objects[9].is_drawn);
  EXPECT_EQ(objects[10].material, Material::kWrap);
  EXPECT_TRUE(scenario.slots.empty()) << "no fork-lift takes what is wrapped";
}

TEST(Scenario, RefusesWrongRacksGlassAndWrapWithTheirLine) {
  EXPECT_EQ(complaint_of(kRoom + "racks:\n  - {corner: [3, 1, 0], pitch: [0.08, 1]}\n"),
            "world.yaml: line 6: 'pitch' must be more than a post's width");
  EXPECT_EQ(complaint_of(kRoom + "racks:\n  - {corner: [3, 1, 0]}\n"),
            "world.yaml: line 6: 'pitch' is missing in 'racks'");
  EXPECT_EQ(complaint_of(kRoom + "glass:\n  - {line: [[1, 1]]}\n"),
            "world.yaml: line 6: 'line' must be a list of at least two points");
  EXPECT_EQ(complaint_of(kRoom + "glass:\n  - {drawn: true}\n"), "world.yaml: line 6: 'line' is missing in 'glass'");
  EXPECT_EQ(complaint_of(kRoom + "wrapped:\n  - [1, 1, 1, 0, 0]\n"),
            "world.yaml: line 6: 'box' needs a width and a height");
  EXPECT_EQ(complaint_of(kRoom + "laser:\n  glass_within_deg: 91\n"),
            "world.yaml: line 6: 'glass_within_deg' must lie from 0 to 90");
  EXPECT_EQ(complaint_of(kRoom + "laser:\n  wrap_no_return_share: 0.6\n  wrap_through_share: 0.6\n"),
            "world.yaml: line 6: 'wrap_no_return_share' and the other shares of wrap are more than 1 together");
}

TEST(Scenario, ReadsContainersThatCreepAndAStartInAChangedHall) {
  const Scenario scenario = parse_scenario(kRoom +
                                               "creep: {containers: 2, step_m: 0.02, times: 5, direction_deg: 90}\n"
                                               "changed_at_start: {share: 0.75, changes: [removed]}\n",
                                           "world.yaml");
  EXPECT_EQ(scenario.creep->containers, 2);
  EXPECT_NEAR(*scenario.creep->direction_rad, radians(90), 1e-12);
  EXPECT_EQ(scenario.changed_at_start->share, 0.75);
  EXPECT_EQ(scenario.changed_at_start->kinds, std::vector{ChangeKind::kRemoved});
  EXPECT_EQ(complaint_of(kRoom + "creep:\n  times: 0\n"), "world.yaml: line 6: 'times' must lie from 1 to 10000");
  EXPECT_EQ(complaint_of(kRoom + "changed_at_start:\n  share: 1.5\n"),
            "world.yaml: line 6: 'share' must lie from 0 to 1");
  EXPECT_EQ(complaint_of(kRoom + "forklift:\n  changes: [crept]\n"),
            "world.yaml: line 6: 'changes' must list removed, added or shifted");
}

TEST(Scenario, ReadsActorsAndDoors) {
  const Scenario scenario =
      parse_scenario(kRoom +
                         "actors:\n  - {path: [[2, 1], [3, 1]], body: forklift, gate: [-1, 1], stop_most_s: 60}\n"
                         "doors:\n  - {leaf: [5, 0, 5, 1], swing_deg: 90, open_share: 0.5, drawn: open}\n",
                     "world.yaml");
  EXPECT_TRUE(scenario.actors.at(0).is_forklift);
  EXPECT_EQ(scenario.actors.at(0).gate->x(), -1.0);
  EXPECT_EQ(scenario.actors.at(0).stop_most_s, 60.0);
  EXPECT_NEAR(scenario.doors.at(0).swing_rad, radians(90), 1e-12);
  EXPECT_TRUE(scenario.doors.at(0).is_drawn_open);
  EXPECT_EQ(complaint_of(kRoom + "actors:\n  - {path: [[2, 1]]}\n"),
            "world.yaml: line 6: 'path' must have at least two points");
  EXPECT_EQ(complaint_of(kRoom + "actors:\n  - path: [[2, 1], [3, 1]]\n    body: horse\n"),
            "world.yaml: line 7: 'body' must be person or forklift");
  EXPECT_EQ(complaint_of(kRoom + "actors:\n  - path: [[2, 1], [3, 1]]\n    stop_least_s: 0\n"),
            "world.yaml: line 7: 'stop_least_s' must lie from 0.1 to 1e+06");
  EXPECT_EQ(complaint_of(kRoom + "doors:\n  - {leaf: [5, 0, 5]}\n"),
            "world.yaml: line 6: 'leaf' must be a list of 4 numbers");
  EXPECT_EQ(complaint_of(kRoom + "doors:\n  - {leaf: [5, 0, 5, 0]}\n"),
            "world.yaml: line 6: 'leaf' must have a length");
  EXPECT_EQ(complaint_of(kRoom + "doors:\n  - {leaf: [5, 0, 5, 1], drawn: ajar}\n"),
            "world.yaml: line 6: 'drawn' must be closed or open");
}

TEST(Scenario, EveryDeliveredScenarioCanBeRead) {
  int count = 0;
  for (const auto& entry : std::filesystem::directory_iterator(test::source_path("config/scenarios"))) {
    EXPECT_FALSE(read_scenario(entry.path()).world.objects.empty()) << entry.path();
    ++count;
  }
  EXPECT_GE(count, 6);
  for (const char* name : {"hall", "hall_shifts", "room", "demo"}) {
    const Scenario scenario = read_scenario(test::source_path("config/scenarios/") + name + ".yaml");
    EXPECT_TRUE(scenario.forklift) << name;
    EXPECT_FALSE(scenario.slots.empty()) << name;
  }
}

}  // namespace
}  // namespace deltamap::simulation
