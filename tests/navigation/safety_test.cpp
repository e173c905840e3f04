// SPDX-License-Identifier: Apache-2.0
#include "navigation/safety.hpp"

#include <gtest/gtest.h>

#include <limits>
#include <numbers>

namespace deltamap::navigation {
namespace {

constexpr Timestamp kNow = timestamp_from_ns(1'000'000'000'000);

Timestamp after(double s) { return kNow + duration_from_seconds(s); }

Scan hall(float range_m, Timestamp time = kNow) {
  Scan scan;
  scan.time = time;
  scan.received = time;
  scan.first_bearing_rad = -std::numbers::pi / 2.0;
  scan.bearing_step_rad = std::numbers::pi / 180.0;
  scan.max_range_m = 8.0;
  for (int i = 0; i < 181; ++i) scan.beams.push_back({i % 2 == 0 ? range_m : range_m + 0.02F, 0.0F, BeamKind::kRange});
  return scan;
}

Odometry driving() {
  Odometry odometry;
  odometry.time = kNow;
  odometry.motors_enabled = true;
  odometry.battery_v = 12.5;
  return odometry;
}

/// The controller has told a watchdog of 2 s.
Safety put_down(const SafetyParams& params = {}) {
  Safety safety{params};
  safety.set_stopping_behaviour({.watchdog_s = 2.0});
  return safety;
}

/// On a plane 6 m away a few metres ago: its scans have followed its wheels.
Safety with_watchdog(const SafetyParams& params = {}) {
  Safety safety = put_down(params);
  for (int i = 0; i < 10; ++i) {
    Odometry odometry = driving();
    odometry.time = after(0.1 * i - 2.0);
    odometry.odom_from_robot.x = 0.05 * i - 2.0;
    safety.observe(odometry);
    Scan scan = hall(6.0F, odometry.time);
    for (std::size_t beam = 0; beam < scan.beams.size(); ++beam) {
      const double ahead_m = (6.0 - 0.05 * i) / std::max(0.1, std::cos(scan.bearing_rad(beam)));
      scan.beams[beam].range_m = static_cast<float>(ahead_m);
      if (ahead_m > scan.max_range_m) scan.beams[beam].kind = BeamKind::kBeyondMaximum;
    }
    safety.observe(scan);
  }
  EXPECT_FALSE(safety.creeps());
  return safety;
}

/// All is well: a free hall, motors on, a fresh command.
Safety at_ease(double speed_m_per_s = 0.5, double turn_rate_rad_per_s = 0.2) {
  Safety safety = with_watchdog();
  safety.observe(hall(6.0F));
  safety.observe(driving());
  safety.command({kNow, speed_m_per_s, turn_rate_rad_per_s}, kNow);
  return safety;
}

/// v · (reaction + watchdog + cycle) + v² / 2a: what the robot travels on when nobody speaks to it any more.
double blind_travel_m(double v, double watchdog_s = 2.0, double deceleration_m_per_s2 = 0.3) {
  constexpr double kReactionS = 0.1;
  constexpr double kCycleS = 0.1;
  return v * (kReactionS + watchdog_s + kCycleS) + v * v / (2.0 * deceleration_m_per_s2);
}

void expect_stop(const AllowedMotion& motion, StopReason reason) {
  EXPECT_EQ(motion.stop, reason) << name_of(motion.stop);
  EXPECT_EQ(motion.speed_m_per_s, 0.0);
}

TEST(Safety, LetsACommandThroughWhereAllIsWell) {
  const AllowedMotion motion = at_ease().allowed(kNow);
  EXPECT_EQ(motion.stop, StopReason::kNone);
  EXPECT_EQ(motion.speed_m_per_s, 0.5);
  EXPECT_EQ(motion.turn_rate_rad_per_s, 0.2);
}

TEST(Safety, LetsItCreepOnTheSameArcUntilItsLaserHasShownThatItLooksAhead) {
  Safety safety = put_down();
  safety.observe(hall(6.0F));
  safety.observe(driving());
  EXPECT_TRUE(safety.creeps());
  safety.command({kNow, 0.5, 0.2}, kNow);
  EXPECT_NEAR(safety.allowed(kNow).speed_m_per_s, 0.1, 1e-9);
  EXPECT_NEAR(safety.allowed(kNow).turn_rate_rad_per_s, 0.04, 1e-9);
  safety.command({kNow, 0.05, 0.2}, kNow);
  EXPECT_EQ(safety.allowed(kNow).speed_m_per_s, 0.05);
  safety.command({kNow, 0.0, 0.5}, kNow);
  EXPECT_EQ(safety.allowed(kNow).turn_rate_rad_per_s, 0.5) << "on the spot the hull goes nowhere";
}

TEST(Safety, StandsStillUntilSomeoneDrives) {
  Safety safety = with_watchdog();
  safety.observe(hall(6.0F));
  safety.observe(driving());
  expect_stop(safety.allowed(kNow), StopReason::kNoCommand);
  safety.command({kNow, 0.5, 0.0}, kNow);
  EXPECT_GT(safety.allowed(kNow).speed_m_per_s, 0.0);
  safety.release();
  expect_stop(safety.allowed(kNow), StopReason::kNoCommand);
}

TEST(Safety, LetsACommandExpireAfterItsLifeFromItsArrival) {
  Safety safety = with_watchdog({.nominal_scan_period_s = 10.0});
  safety.observe(hall(6.0F));
  safety.observe(driving());
  safety.command({kNow, 0.5, 0.2}, after(0.1));  // decided on a scan of 0.1 s ago
  EXPECT_EQ(safety.allowed(after(0.39)).stop, StopReason::kNone);
  const AllowedMotion late = safety.allowed(after(0.41));
  expect_stop(late, StopReason::kCommandExpired);
  EXPECT_EQ(late.turn_rate_rad_per_s, 0.0);
}

TEST(Safety, StopsForAStaleLaserAfterThreePeriods) {
  Safety safety = at_ease();
  safety.set_nominal_scan_period(0.05);
  EXPECT_EQ(safety.allowed(after(0.149)).stop, StopReason::kNone);
  const AllowedMotion late = safety.allowed(after(0.151));
  expect_stop(late, StopReason::kStaleLaser);
  EXPECT_EQ(late.turn_rate_rad_per_s, 0.0);
  Safety blind{{}};
  blind.observe(driving());
  blind.command({kNow, 0.5, 0.0}, kNow);
  expect_stop(blind.allowed(kNow), StopReason::kStaleLaser);
}

TEST(Safety, StopsWithoutAnyOdometry) {
  Safety safety{{}};
  safety.observe(hall(6.0F));
  safety.command({kNow, 0.5, 0.0}, kNow);
  expect_stop(safety.allowed(kNow), StopReason::kNoOdometry);
}

TEST(Safety, RefusesToReverse) { expect_stop(at_ease(-0.2).allowed(kNow), StopReason::kReverse); }

TEST(Safety, StopsBeforeAnObstacleAndLetsTheRobotTurnAway) {
  Safety safety = at_ease();
  Scan scan = hall(6.0F);
  scan.beams[90].range_m = 0.33F;
  safety.observe(scan);
  const AllowedMotion motion = safety.allowed(kNow);
  expect_stop(motion, StopReason::kObstacle);
  EXPECT_EQ(motion.turn_rate_rad_per_s, 0.2);
}

TEST(Safety, DoesNotTurnInsideItsOwnSwingCircle) {
  for (const double speed : {0.0, 0.5}) {
    Safety safety = at_ease(speed);
    Scan scan = hall(6.0F);
    scan.beams[10].range_m = 0.2F;
    safety.observe(scan);
    const AllowedMotion motion = safety.allowed(kNow);
    EXPECT_EQ(motion.turn_rate_rad_per_s, 0.0);
    if (speed == 0.0) expect_stop(motion, StopReason::kObstacle);
  }
}

TEST(Safety, SlowsDownSoFarThatTheStopDistanceIsFree) {
  const SafetyParams params;
  Safety safety = at_ease(0.7, 0.0);
  for (const float range_m : {0.5F, 0.7F, 1.0F, 1.5F}) {
    safety.observe(hall(range_m));
    const AllowedMotion motion = safety.allowed(kNow);
    const double free_m = static_cast<double>(range_m) - params.robot_radius_m - params.margin_m;
    EXPECT_LE(blind_travel_m(motion.speed_m_per_s), free_m) << range_m;
    EXPECT_GT(blind_travel_m(motion.speed_m_per_s), 0.85 * free_m) << range_m << ": it must still get about";
  }
}

/// A border 1 m wide across the way.
ZonesAround border_at(double ahead_m, Timestamp time = kNow) {
  ZonesAround zones{.time = time, .bind = true};
  for (int i = -5; i <= 5; ++i) zones.blocked_in_robot.emplace_back(ahead_m, 0.1 * i);
  return zones;
}

TEST(Safety, ComesToRestBeforeABlockedZoneWhoeverDrivesAndLetsTheRobotTurnAway) {
  Safety safety = at_ease(0.7, 0.0);
  safety.heed(border_at(1.5));
  const double v = safety.allowed(kNow).speed_m_per_s;
  EXPECT_LT(v, 0.7);
  EXPECT_GT(v, 0.2);
  EXPECT_LT(blind_travel_m(v), 1.5 - 0.34);
  safety.heed(border_at(1.5, after(-0.5)));
  EXPECT_LT(safety.allowed(kNow).speed_m_per_s, v) << "it is nearer by now";
  safety.heed(border_at(2.9, after(-60.0)));
  expect_stop(safety.allowed(kNow), StopReason::kPoseUnknown);
  safety.heed({.time = after(-60.0), .bind = true});
  expect_stop(safety.allowed(kNow), StopReason::kPoseUnknown);  // no border was near then
  safety.heed(border_at(0.33));
  safety.command({kNow, 0.5, 0.3}, kNow);
  expect_stop(safety.allowed(kNow), StopReason::kBlockedZone);
  EXPECT_EQ(safety.allowed(kNow).turn_rate_rad_per_s, 0.3);
  EXPECT_FALSE(safety.allowed(kNow).brake_hard) << "a line on the map is no wall";
  safety.heed({});
  EXPECT_EQ(safety.allowed(kNow).speed_m_per_s, 0.5) << "of a pose that does not hold";
}

TEST(Safety, AWallBeforeABlockedZoneIsAnObstacle) {
  Safety safety = at_ease(0.5, 0.0);
  safety.observe(hall(0.36F));
  safety.heed(border_at(0.5));
  expect_stop(safety.allowed(kNow), StopReason::kObstacle);
}

TEST(Safety, DrivesNoFasterThanASlowZoneAllowsOnTheArcThatWasAskedFor) {
  Safety safety = at_ease(0.5, 0.2);
  safety.heed({.time = kNow, .most_speed_m_per_s = 0.25});
  EXPECT_NEAR(safety.allowed(kNow).speed_m_per_s, 0.25, 1e-9);
  EXPECT_NEAR(safety.allowed(kNow).turn_rate_rad_per_s, 0.1, 1e-9);
  safety.command({kNow, 0.2, 0.2}, kNow);
  EXPECT_EQ(safety.allowed(kNow).turn_rate_rad_per_s, 0.2);
}

TEST(Safety, KeepsAGreaterDistanceTheOlderTheScan) {
  Safety safety = with_watchdog({.command_life_s = 10.0, .nominal_scan_period_s = 10.0, .odometry_life_s = 10.0});
  safety.observe(hall(1.0F));
  safety.observe(driving());
  safety.command({kNow, 0.7, 0.0}, kNow);
  double before = 1.0;
  for (const double age_s : {0.0, 0.2, 0.5, 1.0, 2.0}) {
    const double v = safety.allowed(after(age_s)).speed_m_per_s;
    EXPECT_LT(v, before);
    EXPECT_NEAR(blind_travel_m(v) + v * age_s, 1.0 - 0.26 - 0.08, 0.04);
    before = v;
  }
}

TEST(Safety, AllowsMoreWhereTheWatchdogIsShorterAndNothingWhereThereIsNone) {
  Safety safety = at_ease(0.7, 0.0);
  safety.observe(hall(1.5F));
  double before = 0.0;
  for (const double watchdog_s : {5.0, 2.0, 1.0, 0.5}) {
    safety.set_stopping_behaviour({.watchdog_s = watchdog_s});
    const double v = safety.allowed(kNow).speed_m_per_s;
    EXPECT_GT(v, before);
    EXPECT_LE(blind_travel_m(v, watchdog_s), 1.5 - 0.34);
    before = v;
  }
  safety.set_stopping_behaviour({.watchdog_s = std::numeric_limits<double>::infinity()});
  expect_stop(safety.allowed(kNow), StopReason::kNoWatchdog);
}

TEST(Safety, CountsOnTheWeakerOfTwoBrakings) {
  Safety safety = at_ease(0.7, 0.0);
  safety.observe(hall(1.5F));
  const double as_set = safety.allowed(kNow).speed_m_per_s;
  safety.set_stopping_behaviour({.watchdog_s = 2.0, .deceleration_m_per_s2 = 1.0});
  EXPECT_EQ(safety.allowed(kNow).speed_m_per_s, as_set) << "the settings say 0.3";
  safety.set_stopping_behaviour({.watchdog_s = 2.0, .deceleration_m_per_s2 = 0.1});
  EXPECT_LT(safety.allowed(kNow).speed_m_per_s, as_set);
}

TEST(Safety, TakesWhatLiesBeyondTheLaserForUnsure) {
  Safety safety = at_ease(0.7, 0.0);
  Scan scan = hall(0.0F);
  scan.max_range_m = 1.2;
  for (Beam& beam : scan.beams) beam.kind = BeamKind::kBeyondMaximum;
  safety.observe(scan);
  const double v = safety.allowed(kNow).speed_m_per_s;
  EXPECT_GT(v, 0.1);
  EXPECT_LE(blind_travel_m(v), 1.2 - 0.34);
}

TEST(Safety, SlowsDownOnTheArcThatWasAskedFor) {
  Safety safety = at_ease(0.5, 0.2);
  safety.observe(hall(1.2F));
  const AllowedMotion motion = safety.allowed(kNow);
  EXPECT_LT(motion.speed_m_per_s, 0.5);
  EXPECT_NEAR(motion.turn_rate_rad_per_s / motion.speed_m_per_s, 0.2 / 0.5, 1e-9);
}

TEST(Safety, NeverTurnsBlindlyOutOfWhatTheLaserSees) {
  const AllowedMotion motion = at_ease(0.3, 1.2).allowed(kNow);
  EXPECT_GT(motion.speed_m_per_s, 0.1);
  EXPECT_LT(motion.turn_rate_rad_per_s * 2.2, std::numbers::pi / 2.0);
}

TEST(Safety, DoesNotTurnAsideWhereItWouldSlideIntoSomething) {
  Safety safety = at_ease(0.0, 0.8);
  Odometry moving = driving();
  moving.speed_m_per_s = 0.5;  // it slides 0.4 m yet
  Scan scan = hall(6.0F);
  for (std::size_t i = 130; i < 150; ++i) scan.beams[i].range_m = 0.5F;  // left ahead
  safety.observe(moving);
  safety.observe(scan);
  EXPECT_EQ(safety.allowed(kNow).turn_rate_rad_per_s, 0.0);
  moving.speed_m_per_s = 0.0;
  safety.observe(moving);
  EXPECT_EQ(safety.allowed(kNow).turn_rate_rad_per_s, 0.8);
}

TEST(Safety, BrakesHardForWhatHasComeNearerThanItsBraking) {
  Safety safety = at_ease(0.5, 0.0);
  Odometry moving = driving();
  moving.speed_m_per_s = 0.5;  // 0.05 m until it brakes, then 0.42 m
  safety.observe(moving);
  safety.observe(hall(1.0F));
  EXPECT_FALSE(safety.allowed(kNow).brake_hard);
  safety.observe(hall(0.7F));
  const AllowedMotion motion = safety.allowed(kNow);
  expect_stop(motion, StopReason::kObstacle);
  EXPECT_TRUE(motion.brake_hard);
}

TEST(Safety, BrakesHardForWhatIsTooNearWhateverItStandsFor) {
  for (const double watchdog_s : {2.0, std::numeric_limits<double>::infinity()}) {
    Safety safety = at_ease();
    safety.set_stopping_behaviour({.watchdog_s = watchdog_s});
    Odometry moving = driving();
    moving.speed_m_per_s = 0.5;
    moving.charging = true;
    safety.observe(moving);
    safety.observe(hall(1.0F));
    EXPECT_FALSE(safety.allowed(kNow).brake_hard) << "it has room to brake";
    safety.observe(hall(0.7F));
    const AllowedMotion motion = safety.allowed(kNow);
    expect_stop(motion, StopReason::kCharging);
    EXPECT_TRUE(motion.brake_hard) << "told to stand, it goes on";
    safety.release();
    EXPECT_TRUE(safety.allowed(kNow).brake_hard) << "nobody drives, and it goes on";
    moving.motors_enabled = false;
    safety.observe(moving);
    EXPECT_FALSE(safety.allowed(kNow).brake_hard) << "a person pushes it";
  }
}

TEST(Safety, LooksAlongTheArcThatIsDriven) {
  Scan scan = hall(6.0F);
  scan.beams[150].range_m = 0.4F;  // 60° to the left: beside the straight way, on the way of a bend to the left
  Safety straight = at_ease(0.3, 0.0);
  straight.observe(scan);
  EXPECT_EQ(straight.allowed(kNow).speed_m_per_s, 0.3);
  Safety bend = at_ease(0.3, 0.9);
  bend.observe(scan);
  EXPECT_LT(bend.allowed(kNow).speed_m_per_s, 0.3);
}

TEST(Safety, TakesALaserThatSeesNothingAheadForAWall) {
  Safety safety = at_ease();
  Scan scan = hall(6.0F);
  for (std::size_t i = 60; i < 120; ++i) scan.beams[i].kind = BeamKind::kNotValid;
  safety.observe(scan);
  expect_stop(safety.allowed(kNow), StopReason::kObstacle);
}

TEST(Safety, KeepsSpeedsWithinItsLimits) {
  Safety straight = at_ease(9.0, 0.0);
  straight.observe(hall(20.0F));
  EXPECT_EQ(straight.allowed(kNow).speed_m_per_s, SafetyParams{}.max_speed_m_per_s);
  EXPECT_EQ(at_ease(0.0, -9.0).allowed(kNow).turn_rate_rad_per_s, -SafetyParams{}.max_turn_rate_rad_per_s);
}

TEST(Safety, StopsForACommandThatIsNoNumber) {
  expect_stop(at_ease(std::numeric_limits<double>::quiet_NaN(), 0.0).allowed(kNow), StopReason::kNoCommand);
  expect_stop(at_ease(0.1, std::numeric_limits<double>::infinity()).allowed(kNow), StopReason::kNoCommand);
}

}  // namespace
}  // namespace deltamap::navigation
