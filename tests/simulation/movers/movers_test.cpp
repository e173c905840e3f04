// SPDX-License-Identifier: Apache-2.0
// People, actors and doors beside a robot that drives.
#include "simulation/movers/movers.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <map>

#include "simulation/simulation.hpp"
#include "simulation/virtual_drive.hpp"
#include "tests/support/files/source_tree.hpp"

namespace deltamap::simulation {
namespace {

Scenario endurance() { return read_scenario(test::source_path("config/scenarios/endurance.yaml")); }

TEST(Movers, LetTheRobotDriveAboutAmongTenActorsAndDoors) {
  VirtualDriveParams params;
  params.seed = 2;
  params.forklift = ForkliftParams{.change_every_s = 20.0};
  VirtualDrive drive{endurance(), params};
  const double body_m = drive.robot_radius_m();
  double driven_m = 0.0;
  double least_gap_m = 10.0;
  int stalled = 0;
  int odometry = 0;
  std::map<MoverEvent::Kind, int> events;
  Pose2 last = drive.map_from_robot();
  for (int scan = 0; scan < 8000; ++scan) {
    const DriveStep step = drive.next();
    for (const Odometry& message : step.odometry) {
      stalled += message.stalled ? 1 : 0;
      ++odometry;
    }
    for (const Actor& actor : drive.movers().actors()) {
      if (!actor.is_in_hall()) continue;
      least_gap_m = std::min(least_gap_m, distance_between(drive.map_from_robot().position(), actor.box()) - body_m);
    }
    for (const MoverEvent& event : step.events) ++events[event.kind];
    driven_m += distance_between(last, step.map_from_robot);
    last = step.map_from_robot;
  }
  EXPECT_GT(driven_m, 200.0) << "of 425 m without anyone in the way";
  EXPECT_GT(least_gap_m, -0.05) << "nobody is run over";
  EXPECT_LT(static_cast<double>(stalled) / odometry, 0.02);
  EXPECT_GE(events[MoverEvent::Kind::kStopped], 10);
  EXPECT_GE(events[MoverEvent::Kind::kOpened], 3);
  EXPECT_GE(events[MoverEvent::Kind::kShut], 3);
}

TEST(Movers, RepeatFromTheirSeed) {
  const auto path_of = [](std::uint64_t seed) {
    VirtualDrive drive{endurance(), {.seed = seed}};
    std::vector<double> seen;
    for (int scan = 0; scan < 600; ++scan) {
      (void)drive.next();
      for (const Actor& actor : drive.movers().actors()) seen.push_back(actor.box().centre.x());
    }
    return seen;
  };
  EXPECT_EQ(path_of(5), path_of(5));
  EXPECT_NE(path_of(5), path_of(6));
}

TEST(Movers, ShowAStandingForkLiftInTheScans) {
  Scenario scenario = read_scenario(test::source_path("config/scenarios/hall.yaml"));
  scenario.laser.optics.range_noise_m = scenario.laser.optics.dropout_share = scenario.laser.optics.mixed_share = 0.0;
  scenario.actors.push_back(
      {.path = {{8.0, 2.5}, {8.0, 2.6}}, .is_forklift = true, .walk_least_s = 1e5, .walk_most_s = 2e5});
  VirtualDrive drive{scenario, {}};
  // Across the robot's way: half its width before its middle.
  EXPECT_NEAR(drive.next().scan.beams[90].range_m, 8.0 - 0.6 - 2.5 - 0.021, 0.02);
}

TEST(Movers, TellTheTruthOfTheLiveSimulatorWhatIsNoChange) {
  Scenario scenario = endurance();
  scenario.forklift.reset();
  for (ActorParams& actor : scenario.actors) actor.stop_most_s = 10.0;
  for (DoorParams& door : scenario.doors) door.period_s = 20.0;
  const Timestamp start = timestamp_from_ns(1'700'000'000'000'000'000);
  Simulation live{scenario, {4, start, std::nullopt}};
  std::map<MoverEvent::Kind, int> told;
  live.advance_to(start + std::chrono::seconds{90});
  for (const TruthRecord& record : live.take_truth()) {
    EXPECT_FALSE(std::holds_alternative<TruthChange>(record));
    if (const auto* event = std::get_if<TruthEvent>(&record)) ++told[event->event.kind];
  }
  EXPECT_GE(told[MoverEvent::Kind::kStopped], 10);
  EXPECT_GE(told[MoverEvent::Kind::kWent], 5);
  EXPECT_GE(told[MoverEvent::Kind::kOpened], 4);
  EXPECT_GE(told[MoverEvent::Kind::kShut], 4);
}

}  // namespace
}  // namespace deltamap::simulation
