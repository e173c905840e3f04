// SPDX-License-Identifier: Apache-2.0
// A robot in a drawn room or corridor, on wheels that turn or spin, with a laser that looks ahead or is turned on its
// mount.
#include "navigation/motion_watch.hpp"

#include <gtest/gtest.h>

#include "core/geometry/angle.hpp"
#include "tests/support/scans/cast_scan.hpp"
#include "tests/support/worlds/room_and_corridor.hpp"

namespace deltamap::navigation {
namespace {

constexpr double kScanPeriodS = 0.1;

class TurnedLaser {
 public:
  explicit TurnedLaser(OccupancyGrid world = test::room_with_pillar(), Pose2 start = {3.0, 3.0, 0.4})
      : world_{std::move(world)}, map_from_robot_{start} {}

  /// How far its wheels have gone when `until` is so, or at the end of `most_m`.
  template <typename Until>
  double drive(double speed_m_per_s, double turn_rate_rad_per_s, double most_m, Until&& until) {
    double way_m = 0.0;
    for (double t = 0.0; t < 60.0 && way_m < most_m && !until(); t += kScanPeriodS) {
      const Pose2 step{speed_m_per_s * kScanPeriodS, 0.0, turn_rate_rad_per_s * kScanPeriodS};
      odom_from_robot_ = odom_from_robot_ * step;
      if (!wheels_spin) map_from_robot_ = map_from_robot_ * step;
      way_m += step.x;
      look();
    }
    return way_m;
  }
  double drive_until_it_looks_ahead(double speed_m_per_s, double turn_rate_rad_per_s = 0.0) {
    return drive(speed_m_per_s, turn_rate_rad_per_s, 3.0, [&] { return watch.looks_ahead(); });
  }
  double drive_until_contradicted(double speed_m_per_s, double turn_rate_rad_per_s = 0.0) {
    return drive(speed_m_per_s, turn_rate_rad_per_s, 1.0, [&] { return watch.contradicts_wheels(); });
  }
  /// Somebody pushes the robot: its wheels slide.
  void shove(double aside_m) { map_from_robot_ = map_from_robot_ * Pose2{0.0, aside_m, 0.0}; }
  void pass(double for_s) { now_ += duration_from_seconds(for_s); }

  void look() {
    pass(kScanPeriodS);
    // The laser is turned, and its scans say that it sits as told.
    Scan scan = test::cast_scan(world_, map_from_robot_, now_,
                                {.max_range_m = 8.0, .robot_from_laser = mount * Pose2{0.0, 0.0, turned_rad}}, noise_);
    scan.robot_from_laser = mount;
    watch.observe(scan, odom_from_robot_, epoch);
  }

  MotionWatch watch;
  Pose2 mount{0.1, 0.0, 0.0};
  double turned_rad = 0.0;
  bool wheels_spin = false;
  std::uint32_t epoch = 1;

 private:
  OccupancyGrid world_;
  Pose2 map_from_robot_;
  Pose2 odom_from_robot_;
  Random noise_{7};
  Timestamp now_ = timestamp_from_ns(1'000'000'000'000);
};

constexpr double kCreepingMPerS = 0.1;
constexpr double kFreeM = 0.3;  // what an operator leaves free around it
constexpr double kStandsM = 0.05;

TEST(MotionWatch, IsShownWithinTwoDecimetresThatTheLaserLooksAhead) {
  for (const double turn_rate : {0.0, 0.1, -0.2}) {
    TurnedLaser robot;
    robot.look();
    EXPECT_FALSE(robot.watch.looks_ahead());
    EXPECT_LT(robot.drive_until_it_looks_ahead(kCreepingMPerS, turn_rate), 0.2) << turn_rate;
    EXPECT_FALSE(robot.watch.contradicts_wheels());
  }
}

TEST(MotionWatch, IsShownNothingByATurnOnTheSpot) {
  for (const double turned_rad : {0.0, radians(180.0)}) {
    TurnedLaser robot;
    robot.turned_rad = turned_rad;
    (void)robot.drive(0.0, 0.5, 1.0, [] { return false; });
    EXPECT_FALSE(robot.watch.looks_ahead());
    EXPECT_FALSE(robot.watch.contradicts_wheels());
  }
}

TEST(MotionWatch, ContradictsALaserThatIsTurnedBeforeTheRobotHasUsedItsRoom) {
  for (const double turned_rad : {radians(180.0), radians(90.0), radians(-90.0)}) {
    for (const double heading_rad : {0.0, 0.4, 1.6, 2.5, -1.0, -2.2}) {
      TurnedLaser robot{test::room_with_pillar(), {3.0, 3.0, heading_rad}};
      robot.turned_rad = turned_rad;
      robot.look();
      EXPECT_LT(robot.drive_until_contradicted(kCreepingMPerS), kFreeM - kStandsM) << turned_rad << " " << heading_rad;
      EXPECT_FALSE(robot.watch.looks_ahead());
    }
  }
}

TEST(MotionWatch, ContradictsALaserThatLooksBackAskewWithinHalfAMetre) {
  for (const double turned_deg : {135.0, -135.0}) {
    TurnedLaser robot;
    robot.turned_rad = radians(turned_deg);
    robot.look();
    EXPECT_LT(robot.drive_until_contradicted(0.4), 0.6) << turned_deg;
  }
}

TEST(MotionWatch, ContradictsWheelsThatSpinFromTheStart) {
  TurnedLaser robot;
  robot.wheels_spin = true;
  robot.look();
  EXPECT_LT(robot.drive_until_contradicted(kCreepingMPerS), kFreeM - kStandsM);
}

TEST(MotionWatch, ForgetsASingleContradictionOnceScansHaveFollowedTheWheelsAgain) {
  const auto never = [] { return false; };
  const auto contradicted_by_shoves = [&](double aside_m, double way_between_m) {
    TurnedLaser robot;
    robot.drive(0.3, 0.0, 0.4, never);
    for (const double side : {1.0, -1.0, 1.0}) {
      robot.shove(side * aside_m);
      robot.drive(0.3, 0.0, 0.28, never);
      if (robot.watch.contradicts_wheels()) return true;
      robot.drive(0.3, 0.6, way_between_m, never);
    }
    return false;
  };
  for (const double aside_m : {0.9, 1.0}) {
    EXPECT_TRUE(contradicted_by_shoves(aside_m, 0.0)) << "one after another: " << aside_m;
    EXPECT_FALSE(contradicted_by_shoves(aside_m, 0.9)) << "long after the one before: " << aside_m;
  }
}

TEST(MotionWatch, TakesTheLaserForWellMountedAfterAMetreThatShowsNothing) {
  TurnedLaser robot{test::long_corridor(), {20.0, 1.0, 0.0}};
  robot.look();
  const double way_m = robot.drive_until_it_looks_ahead(kCreepingMPerS);
  EXPECT_GT(way_m, 0.9);
  EXPECT_LT(way_m, 1.1);
  EXPECT_FALSE(robot.watch.contradicts_wheels());
}

TEST(MotionWatch, IsToBeShownAgainAfterWhateverMayHaveTurnedTheLaser) {
  const auto proven = [] {
    TurnedLaser robot;
    (void)robot.drive_until_it_looks_ahead(kCreepingMPerS);
    EXPECT_TRUE(robot.watch.looks_ahead());
    return robot;
  };
  TurnedLaser robot = proven();
  robot.pass(1.0);
  robot.look();
  EXPECT_TRUE(robot.watch.looks_ahead()) << "a moment without a scan";
  robot.pass(6.0);
  robot.look();
  EXPECT_FALSE(robot.watch.looks_ahead()) << "the laser was silent";
  robot = proven();
  ++robot.epoch;
  robot.look();
  EXPECT_FALSE(robot.watch.looks_ahead()) << "another connection";
  robot = proven();
  robot.mount.theta = 0.1;
  robot.look();
  EXPECT_FALSE(robot.watch.looks_ahead()) << "another mount";
  robot = proven();
  robot.wheels_spin = true;
  (void)robot.drive_until_contradicted(0.3);
  EXPECT_TRUE(robot.watch.contradicts_wheels());
  robot.watch.forget_contradiction();
  EXPECT_FALSE(robot.watch.contradicts_wheels());
  EXPECT_FALSE(robot.watch.looks_ahead()) << "what has been contradicted";
}

TEST(MotionWatch, IsToBeShownAgainAfterTwoScansThatHaveNothingInCommon) {
  for (const double turned_deg : {45.0, 90.0, -90.0, 180.0}) {
    TurnedLaser robot;
    robot.look();
    robot.drive_until_it_looks_ahead(kCreepingMPerS);
    robot.drive(0.4, 0.0, 0.6, [] { return false; });
    ASSERT_TRUE(robot.watch.looks_ahead());
    robot.turned_rad = radians(turned_deg);  // somebody has knocked against it while the robot turns on the spot
    robot.drive(0.0, 0.8, 1.0, [&] { return !robot.watch.looks_ahead(); });
    EXPECT_FALSE(robot.watch.looks_ahead()) << turned_deg;
  }
}

}  // namespace
}  // namespace deltamap::navigation
