// SPDX-License-Identifier: Apache-2.0
// Scans cast in a drawn room and in a corridor, from where the robot truly is.
#include "navigation/shown_motion.hpp"

#include <gtest/gtest.h>

#include <numbers>

#include "core/grid/grid_ray.hpp"
#include "core/random.hpp"
#include "tests/support/worlds/room_and_corridor.hpp"

namespace deltamap::navigation {
namespace {

const Pose2 kMount{0.021, 0.0, 0.0};

Scan seen(const OccupancyGrid& world, const Pose2& map_from_robot, Random& noise) {
  constexpr double kReachM = 8.0;
  Scan scan;
  scan.robot_from_laser = kMount;
  scan.first_bearing_rad = -std::numbers::pi / 2.0;
  scan.bearing_step_rad = std::numbers::pi / 180.0;
  scan.max_range_m = kReachM;
  const Pose2 map_from_laser = map_from_robot * kMount;
  for (std::size_t i = 0; i < 181; ++i) {
    const double bearing = scan.bearing_rad(i);
    const Point2 end = map_from_laser * Point2{kReachM * std::cos(bearing), kReachM * std::sin(bearing)};
    Beam beam{0.0F, 0.0F, BeamKind::kBeyondMaximum};
    walk_ray(world.geometry(), map_from_laser.position(), end, [&](Cell cell, double entered_m) {
      if (world.at(cell) != CellState::kOccupied) return true;
      beam = {static_cast<float>(entered_m + noise.normal(0.01)), 0.0F, BeamKind::kRange};
      return false;
    });
    scan.beams.push_back(beam);
  }
  return scan;
}

ShownMotion shown(const OccupancyGrid& world, const Pose2& from, const Pose2& truly, const Pose2& told) {
  Random noise{7};
  return shown_motion(seen(world, from, noise), seen(world, from * truly, noise), told);
}

TEST(ShownMotion, OfARobotThatDrivesAsItsWheelsTell) {
  for (const Pose2& motion : {Pose2{0.3, 0.0, 0.0}, Pose2{0.25, 0.02, -0.2}}) {
    const ShownMotion answer = shown(test::room_with_pillar(), {3.0, 3.0, 0.4}, motion, motion);
    EXPECT_GT(answer.asked, 15);
    EXPECT_GT(answer.as_told, 0.8);
    EXPECT_LT(answer.otherwise, answer.as_told);
  }
}

TEST(ShownMotion, OfATurnOnTheSpotFitsALaserThatIsTurnedRoundAsWell) {
  const ShownMotion answer = shown(test::room_with_pillar(), {3.0, 3.0, 0.4}, {0.0, 0.0, 0.3}, {0.0, 0.0, 0.3});
  EXPECT_GT(answer.asked, 15);
  EXPECT_GT(answer.as_told, 0.8);
  EXPECT_GT(answer.otherwise, 0.8);
}

TEST(ShownMotion, OfALaserThatIsTurnedWhileTheRobotDrivesACurve) {
  for (const double turned_rad : {radians(90.0), radians(180.0), radians(-90.0)}) {
    const Pose2 told{0.25, 0.02, 0.15};
    const Pose2 turn{0.0, 0.0, turned_rad};
    const ShownMotion answer = shown(test::room_with_pillar(), {3.0, 3.0, 0.4}, inverse(turn) * told * turn, told);
    EXPECT_GT(answer.asked, 15);
    EXPECT_GT(answer.otherwise, 0.8);
    EXPECT_LT(answer.as_told, answer.otherwise - 0.4) << turned_rad;
  }
}

TEST(ShownMotion, OfARobotThatCreepsIsToldByATenthOfAMetre) {
  const Pose2 told{0.1, 0.0, 0.0};
  Random noise{7};
  const Scan before = seen(test::room_with_pillar(), {3.0, 3.0, 0.4}, noise);
  const Scan ahead = seen(test::room_with_pillar(), Pose2{3.0, 3.0, 0.4} * told, noise);
  const Scan back = seen(test::room_with_pillar(), Pose2{3.0, 3.0, 0.4} * inverse(told), noise);
  const ShownMotion as_told = shown_motion(before, ahead, told, Likeness::creeping());
  EXPECT_GT(as_told.asked, 15);
  EXPECT_GT(as_told.as_told, as_told.otherwise + 0.4);
  const ShownMotion reversed = shown_motion(before, back, told, Likeness::creeping());
  EXPECT_GT(reversed.otherwise, reversed.as_told + 0.4);
}

TEST(ShownMotion, OfARobotThatStandsWhileItsWheelsTurn) {
  for (const Pose2& told : {Pose2{0.3, 0.0, 0.0}, Pose2{0.0, 0.0, 0.3}, Pose2{0.25, 0.02, -0.2}}) {
    const ShownMotion answer = shown(test::room_with_pillar(), {3.0, 3.0, 0.4}, {}, told);
    EXPECT_GT(answer.asked, 15);
    EXPECT_GT(answer.otherwise, 0.9);
    EXPECT_LT(answer.as_told, answer.otherwise - 0.4);
  }
}

TEST(ShownMotion, OfALaserThatIsTurnedRound) {
  const ShownMotion answer = shown(test::room_with_pillar(), {3.0, 3.0, 0.4}, {-0.3, 0.0, 0.0}, {0.3, 0.0, 0.0});
  EXPECT_GT(answer.otherwise, 0.8);
  EXPECT_LT(answer.as_told, 0.4);
}

TEST(ShownMotion, AsksLittleInACorridorThatLooksTheSameFurtherOn) {
  EXPECT_LT(shown(test::long_corridor(), {20.0, 1.0, 0.0}, {}, {0.3, 0.0, 0.0}).asked, 15);
}

}  // namespace
}  // namespace deltamap::navigation
