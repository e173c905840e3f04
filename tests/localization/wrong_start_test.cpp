// SPDX-License-Identifier: Apache-2.0
// The small room of the paper (config/scenarios/room.yaml) with a start pose that is 1.1 m wrong: it must not be called
// right, whether the map has been lived in before or not, and the map must not be rebuilt by it for long.
#include <gtest/gtest.h>

#include <optional>

#include "localization/localizer.hpp"
#include "localization/localizer_params.hpp"
#include "simulation/scenario/start_map.hpp"
#include "simulation/virtual_drive.hpp"
#include "tests/support/files/source_tree.hpp"

namespace deltamap::localization {
namespace {

constexpr double kWrongM = 0.5;

struct Room {
  simulation::Scenario scenario = simulation::read_scenario(test::source_path("config/scenarios/room.yaml"));
  std::shared_ptr<const OccupancyGrid> map = std::make_shared<const OccupancyGrid>(
      simulation::start_map(scenario.world, scenario.robot.map_from_start.position(), 0.05));
};

TrackedScan next(simulation::VirtualDrive& drive, Localizer& localizer) {
  simulation::DriveStep step = drive.next();
  for (const Odometry& odometry : step.odometry) localizer.observe(odometry);
  return localizer.observe(std::move(step.scan));
}

belief::StabilityRecord lived_in(const Room& room) {
  simulation::VirtualDrive drive{room.scenario, {.seed = 5}};
  Localizer localizer{LocalizerParams{}, room.map, particles::InitialPose{drive.map_from_robot()}, 5};
  for (int scan = 0; scan < 4000; ++scan) (void)next(drive, localizer);
  return localizer.stability();
}

/// Longest time in s that a pose that is wrong was called right.
double longest_taken_in_s(const Room& room, const std::optional<belief::StabilityRecord>& stability,
                          std::uint64_t seed) {
  simulation::VirtualDriveParams params{.seed = seed};
  params.forklift = simulation::ForkliftParams{.change_every_s = 20.0, .passage_m = 0.9};
  simulation::VirtualDrive drive{room.scenario, params};
  Pose2 wrong = drive.map_from_robot();
  wrong.x += 1.1;
  Localizer localizer{LocalizerParams{}, room.map, particles::InitialPose{wrong}, seed};
  EXPECT_TRUE(!stability || localizer.restore(*stability));
  double longest_s = 0.0;
  double now_s = 0.0;
  for (int scan = 0; scan < 600; ++scan) {
    const Pose2 truth = drive.map_from_robot();
    const Estimate estimate = next(drive, localizer).estimate;
    const bool taken_in =
        distance_between(estimate.map_from_robot, truth) > kWrongM && estimate.belief.verdict == PoseVerdict::kRight;
    now_s = taken_in ? now_s + params.scan_period_s : 0.0;
    longest_s = std::max(longest_s, now_s);
  }
  return longest_s;
}

TEST(WrongStart, IsNotCalledRightWhereNothingHasProvenStable) {
  const Room room;
  for (const std::uint64_t seed : {1u, 2u, 3u}) EXPECT_LT(longest_taken_in_s(room, std::nullopt, seed), 1.0) << seed;
}

TEST(WrongStart, IsNotCalledRightInARoomThatHasBeenLivedIn) {
  const Room room;
  const belief::StabilityRecord stability = lived_in(room);
  for (const std::uint64_t seed : {1u, 2u, 3u}) EXPECT_LT(longest_taken_in_s(room, stability, seed), 2.0) << seed;
}

}  // namespace
}  // namespace deltamap::localization
