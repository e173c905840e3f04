// SPDX-License-Identifier: Apache-2.0
// What a virtual drive leaves out of what its messages say: systematic wheel errors, slips of the whole robot, late
// odometry, gaps without scans, a mount that is told wrongly, and changes that happen out of sight.
#include <gtest/gtest.h>

#include <cmath>

#include "core/geometry/angle.hpp"
#include "simulation/virtual_drive.hpp"
#include "simulation/world/passages.hpp"
#include "tests/support/files/source_tree.hpp"

namespace deltamap::simulation {
namespace {

const devices::DriveTarget kStraight{.speed_m_per_s = 0.5};

Scenario exact_hall() {
  Scenario scenario = read_scenario(test::source_path("config/scenarios/hall.yaml"));
  scenario.laser.optics.range_noise_m = scenario.laser.optics.dropout_share = scenario.laser.optics.mixed_share = 0.0;
  RobotParams& body = scenario.robot.body;
  body.track_error = body.left_wheel_error = body.right_wheel_error = 0.0;
  body.wheel_noise_m_per_sqrt_m = body.slips_per_m = 0.0;
  return scenario;
}

Pose2 odometry_of(const DriveStep& step) { return step.odometry.back().odom_from_robot; }

/// How far and by how much the wheels counted, and the body went, from now on.
struct Moved {
  Pose2 by_wheels;
  Pose2 truly;
};
Moved moved(VirtualDrive& drive, int scans) {
  const Pose2 wheels = odometry_of(drive.next());
  const Pose2 truth = drive.map_from_robot();
  Pose2 last = wheels;
  for (int scan = 0; scan < scans; ++scan) last = odometry_of(drive.next());
  return {motion_between(wheels, last), motion_between(truth, drive.map_from_robot())};
}

TEST(ReachableFloor, EndsAtAWallHoweverNearOneStandsToIt) {
  const World halves{{{1, ObjectKind::kWall, Polyline{{{0, 0}, {12, 0}, {12, 6}, {0, 6}, {0, 0}}}},
                      {2, ObjectKind::kWall, Polyline{{{6, 0}, {6, 6}}}}}};
  for (const double away_m : {0.4, 0.5, 0.6, 0.7}) {
    const ReachableFloor floor = reachable_floor(halves, {6.0 - away_m, 3.0}, 0.4);
    EXPECT_TRUE(floor.contains({2.0, 3.0})) << away_m;
    EXPECT_FALSE(floor.contains({8.0, 3.0})) << away_m;
  }
}

TEST(WheelErrors, CountTooFarByTheScaleAndDriftWhereTheBodyGoesStraight) {
  Scenario scenario = exact_hall();
  const double drift_rad_per_m = radians(0.2);
  scenario.robot.body = with_wheel_errors(scenario.robot.body, {0.02, 0.0, drift_rad_per_m});
  VirtualDrive drive{scenario, {.odometry_period_s = 0.02}};
  drive.hold(kStraight);
  (void)moved(drive, 30);  // up to speed
  const Moved way = moved(drive, 150);
  EXPECT_NEAR(way.by_wheels.position().norm() / way.truly.position().norm(), 1.02, 0.002);
  const double turned_rad = turn_between(way.truly.theta, way.by_wheels.theta);
  EXPECT_NEAR(turned_rad / way.truly.position().norm(), drift_rad_per_m, 0.1 * drift_rad_per_m + 0.0005);
}

TEST(WheelErrors, TurnTooMuchByTheShare) {
  Scenario scenario = exact_hall();
  scenario.robot.body = with_wheel_errors(scenario.robot.body, {0.01, 0.02, 0.0});
  VirtualDrive drive{scenario, {.odometry_period_s = 0.02}};
  drive.hold({.turn_rate_rad_per_s = 0.3});
  (void)moved(drive, 30);
  const Moved turn = moved(drive, 60);  // less than half a turn
  EXPECT_NEAR(turn.by_wheels.theta / turn.truly.theta, 1.02, 0.004);
}

TEST(VirtualDrive, SlipsByAsMuchAsItShouldWithinAMoment) {
  VirtualDrive drive{exact_hall(), {.odometry_period_s = 0.02, .slips = SlipParams{.every_m = 3.0, .turn_rad = 0.1}}};
  drive.hold({.speed_m_per_s = 0.2});
  int slips = 0;
  DriveStep before = drive.next();
  Pose2 truth = drive.map_from_robot();
  for (int scan = 0; scan < 1000; ++scan) {
    const DriveStep step = drive.next();
    slips += step.slips;
    if (step.slips == 0) {
      before = step;
      truth = drive.map_from_robot();
      continue;
    }
    DriveStep after = step;
    for (int more = 0; more < 6; ++more) after = drive.next();
    const Pose2 wheels = motion_between(odometry_of(before), odometry_of(after));
    const Pose2 body = motion_between(truth, drive.map_from_robot());
    const double length_m = std::abs(wheels.x - body.x);
    const double turn_rad = std::abs(turn_between(body.theta, wheels.theta));
    EXPECT_TRUE(std::abs(length_m - 0.3) < 0.05 || std::abs(turn_rad - 0.1) < 0.01) << length_m << " " << turn_rad;
    before = after;
    truth = drive.map_from_robot();
  }
  EXPECT_GT(slips, 2);
}

TEST(VirtualDrive, GivesOdometryThatIsOlderThanItsStamp) {
  VirtualDrive prompt{exact_hall(), {}};
  VirtualDrive late{exact_hall(), {.odometry_lag_s = 0.12}};
  prompt.hold(kStraight);
  late.hold(kStraight);
  std::vector<Odometry> first, second;
  for (int scan = 0; scan < 60; ++scan) {
    for (const Odometry& odometry : prompt.next().odometry) first.push_back(odometry);
    const DriveStep step = late.next();
    for (const Odometry& odometry : step.odometry) {
      EXPECT_LE(odometry.time, step.scan.received) << "not before it has arrived";
      second.push_back(odometry);
    }
  }
  ASSERT_GT(second.size(), 50U);
  for (std::size_t i = 0; i < second.size(); ++i) {
    EXPECT_EQ(second[i].odom_from_robot, first[i].odom_from_robot);
    EXPECT_EQ(second[i].time, first[i].time + duration_from_seconds(0.12));
  }
}

TEST(VirtualDrive, DrivesOnThroughGapsWithoutScans) {
  VirtualDrive drive{exact_hall(), {.gaps = GapParams{.every_s = 20.0, .least_s = 2.0, .most_s = 10.0}}};
  Timestamp last = drive.next().scan.time;
  int gaps = 0;
  for (int scan = 0; scan < 2000; ++scan) {
    const DriveStep step = drive.next();
    const double since_s = seconds(step.scan.time - last);
    last = step.scan.time;
    if (since_s < 1.0) continue;
    ++gaps;
    EXPECT_GE(since_s, 2.0);
    EXPECT_LE(since_s, 10.2 + VirtualDriveParams{}.scan_period_s);
    EXPECT_NEAR(static_cast<double>(step.odometry.size()), 10.0 * since_s, 3.0) << "the wheels go on reporting";
  }
  EXPECT_GT(gaps, 4);
  EXPECT_LT(gaps, 25);
}

TEST(VirtualDrive, SweepsTheFanThatItIsToldTo) {
  for (const drivers::lms200::ScanVariant fan : {drivers::lms200::ScanVariant{100, 25}, {100, 100}, {180, 50}}) {
    VirtualDrive drive{exact_hall(), {.fan = fan, .scan_period_s = fan.scan_duration_s()}};
    const DriveStep step = drive.next();
    ASSERT_EQ(step.scan.beams.size(), fan.values());
    EXPECT_NEAR(degrees(step.scan.first_bearing_rad), -0.5 * fan.angle_deg, 1e-9);
    EXPECT_NEAR(degrees(step.scan.bearing_rad(fan.values() - 1)), 0.5 * fan.angle_deg, 1e-9);
    const std::size_t ahead = (fan.values() - 1) / 2;
    EXPECT_NEAR(step.scan.beams[ahead].range_m, 35.0 - 2.521, 0.02) << "along the corridor";
    EXPECT_NEAR(seconds(drive.next().scan.time - step.scan.time), fan.scan_duration_s(), 1e-6);
  }
}

TEST(VirtualDrive, TellsAMountThatIsNotTheTrueOne) {
  const Pose2 told{0.04, 0.01, radians(0.5)};
  VirtualDrive drive{exact_hall(), {.told_mount = told}};
  const DriveStep step = drive.next();
  EXPECT_EQ(step.scan.robot_from_laser, told);
  EXPECT_NEAR(step.scan.beams[90].range_m, 35.0 - 2.521, 0.02) << "measured from where it truly is";
}

TEST(VirtualDrive, ChangesOnlyWhatIsOutOfSightWhereItIsToldTo) {
  VirtualDriveParams params;
  params.forklift = ForkliftParams{.change_every_s = 5.0, .kinds = {ChangeKind::kRemoved, ChangeKind::kShifted}};
  params.change_in_view_share = 0.0;
  VirtualDrive drive{exact_hall(), params};
  int changes = 0;
  for (int scan = 0; scan < 1500; ++scan) {
    const Point2 eye = drive.map_from_robot().position();
    const RayCaster before = drive.surfaces();
    for (const Change& change : drive.next().changes) {
      ++changes;
      const Box box = change.from.value_or(change.box);
      for (const Segment& side : faces(box)) {
        const Point2 way = 0.5 * (side.from + side.to) - eye;
        const auto hit = before.cast(eye, std::atan2(way.y(), way.x()), 100.0);
        ASSERT_TRUE(hit.has_value());
        EXPECT_NE(hit->range_m, way.norm());
        EXPECT_LT(hit->range_m, way.norm() - 0.01) << "something stands before it";
      }
    }
  }
  EXPECT_GT(changes, 5);
}

}  // namespace
}  // namespace deltamap::simulation
