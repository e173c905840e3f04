// SPDX-License-Identifier: Apache-2.0
// The daemon drives behind each laser of the family, from its bytes to the map: as it is set, upside down, turned on
// its mount, with a post of the robot's own in view. What is decoded wrong moves the pose, and the map with it.
#include <gtest/gtest.h>

#include <cmath>
#include <ostream>

#include "core/geometry/angle.hpp"
#include "experiments/closed_loop/loop_run.hpp"
#include "tests/support/worlds/quiet_room.hpp"

namespace deltamap {
namespace {

constexpr double kPostDeg = 40.0;  // to the left

struct Laser {
  std::string name;
  int field_deg = 180;
  double step_deg = 1.0;
  bool is_in_cm = false;
  bool is_upside_down = false;
  double mount_yaw_deg = 0.0;
  bool has_post = false;
  friend std::ostream& operator<<(std::ostream& out, const Laser& laser) { return out << laser.name; }
};

/// The virtual laser, and settings that say what it is.
experiments::LoopRun behind(const Laser& laser) {
  experiments::LoopRun run;
  run.scenario = test::quiet_room();
  simulation::LaserSetup& setup = run.scenario.laser;
  setup.field_deg = laser.field_deg;
  setup.step_deg = laser.step_deg;
  setup.resolution_m = laser.is_in_cm ? 0.01 : 0.001;
  setup.max_range_m = laser.is_in_cm ? 80.0 : 32.0;
  setup.optics.robot_from_laser.theta = radians(laser.mount_yaw_deg);
  run.settings = experiments::fitting(run.scenario);
  drivers::lms200::Lms200Params& session = run.settings.laser.session;
  session.variant = {static_cast<std::uint16_t>(laser.field_deg),
                     static_cast<std::uint16_t>(std::lround(100.0 * laser.step_deg))};
  session.units = laser.is_in_cm ? drivers::lms200::Units::kCentimetre : drivers::lms200::Units::kMillimetre;
  if (laser.is_upside_down) {
    run.scenario.faults.push_back(simulation::fault_order("laser-upside-down"));
    session.is_upside_down = true;
  }
  if (laser.has_post) {
    run.scenario.faults.push_back(simulation::fault_order("laser-post=" + std::to_string(std::lround(kPostDeg))));
    session.ignored = {{radians(kPostDeg - 5.0), radians(kPostDeg + 5.0)}};
  }
  return run;
}

class LaserVariants : public testing::TestWithParam<Laser> {};

TEST_P(LaserVariants, AreDecodedLocalizedByAndMappedRight) {
  const experiments::LoopOutcome outcome = outcome_of(behind(GetParam()));
  EXPECT_EQ(outcome.collisions, 0);
  EXPECT_GT(outcome.moved_m, 5.0) << outcome.told;
  EXPECT_LT(outcome.pose_off_m, 0.05);
  EXPECT_EQ(outcome.walls_freed, 0);
}

INSTANTIATE_TEST_SUITE_P(
    Each, LaserVariants,
    testing::Values(Laser{.name = "f180s1"}, Laser{.name = "f180s05", .step_deg = 0.5},
                    Laser{.name = "f100s1", .field_deg = 100},
                    Laser{.name = "f100s05", .field_deg = 100, .step_deg = 0.5},
                    Laser{.name = "f100s025", .field_deg = 100, .step_deg = 0.25},
                    Laser{.name = "f180s05cm", .step_deg = 0.5, .is_in_cm = true},
                    Laser{.name = "f100s025cm", .field_deg = 100, .step_deg = 0.25, .is_in_cm = true},
                    Laser{.name = "upsideDown", .is_upside_down = true},
                    Laser{
                        .name = "upsideDownAndTurned", .step_deg = 0.5, .is_upside_down = true, .mount_yaw_deg = 20.0},
                    Laser{.name = "turned", .step_deg = 0.5, .mount_yaw_deg = -25.0},
                    Laser{.name = "post", .step_deg = 0.5, .has_post = true}),
    [](const auto& laser) { return laser.param.name; });

TEST(LaserVariants, AFastOneSeesTooLittleToDriveByAndTellsWhy) {
  experiments::LoopRun run = behind({.name = "f90s05", .field_deg = 90, .step_deg = 0.5});
  const experiments::LoopOutcome outcome = outcome_of(run);
  EXPECT_LT(outcome.pose_off_m, 0.05);
  EXPECT_EQ(outcome.walls_freed, 0);
  EXPECT_EQ(outcome.moved_m, 0.0);
  EXPECT_EQ(outcome.reason, navigation::StopReason::kWayUncovered);
}

TEST(LaserVariants, APostThatNobodyNamesIsNoReasonToHitAnything) {
  experiments::LoopRun run = behind({.name = "post", .has_post = true});
  run.settings.laser.session.ignored.clear();
  EXPECT_EQ(outcome_of(run).collisions, 0);
}

}  // namespace
}  // namespace deltamap
