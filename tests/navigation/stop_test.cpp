// SPDX-License-Identifier: Apache-2.0
// Every reason to stop: what brings it about, whether it outlives that, and what ends it.
#include <gtest/gtest.h>

#include <functional>
#include <numbers>

#include "core/random.hpp"
#include "navigation/pose_watch.hpp"
#include "navigation/safety.hpp"

namespace deltamap::navigation {
namespace {

constexpr Timestamp kStart = timestamp_from_ns(1'000'000'000'000);
constexpr double kTickS = 0.1;

/// A robot that drives through a free hall; each tick brings a SIP, a scan and a command.
class Drive {
 public:
  Drive() {
    safety.set_stopping_behaviour({.watchdog_s = 2.0});
    odometry.motors_enabled = true;
    odometry.battery_v = 12.5;
    scan.first_bearing_rad = -std::numbers::pi / 2.0;
    scan.bearing_step_rad = std::numbers::pi / 180.0;
    scan.max_range_m = 32.0;
    for (int i = 0; i < 181; ++i) scan.beams.push_back({i % 2 == 0 ? 6.0F : 6.02F, 0.0F, BeamKind::kRange});
  }

  AllowedMotion tick() {
    now = now + duration_from_seconds(kTickS);
    if (drives_on) odometry.odom_from_robot.x += kTickS * 0.3;
    if (flickers) flicker();
    odometry.time = scan.time = scan.received = now;
    if (robot_speaks) safety.observe(odometry);
    if (laser_speaks) safety.observe(scan);
    if (pilot_speaks)
      safety.command({now, speed_m_per_s, 0.1}, now, estimate ? pose_watch.observe(pose()) : StopReason::kNone);
    const AllowedMotion motion = safety.allowed(now);
    if (is_told) safety.told(Motion{motion.speed_m_per_s, motion.turn_rate_rad_per_s}, now);
    return motion;
  }
  /// As a laser that works: no two scans are the same.
  void flicker() {
    for (Beam& beam : scan.beams) beam.range_m = 6.0F + static_cast<float>(random.uniform(-0.01, 0.01));
  }
  PoseNow pose() {
    estimate->time = now;
    return {*estimate, fit, start_fits};
  }
  AllowedMotion run_for(double s) {
    AllowedMotion motion;
    for (double t = 0.0; t < s; t += kTickS) motion = tick();
    return motion;
  }
  void press_motors_button() {
    odometry.motors_enabled = false;
    (void)run_for(0.5);
    odometry.motors_enabled = true;
  }

  Safety safety{{}};
  Random random{1};
  Odometry odometry;
  Scan scan;
  bool robot_speaks = true;
  bool laser_speaks = true;
  bool pilot_speaks = true;
  double speed_m_per_s = 0.3;
  bool is_told = false;  ///< what safety allows, so that the robot is held to it
  PoseWatch pose_watch;
  std::optional<Estimate> estimate;  ///< nothing: the pilot asks for none
  std::optional<double> fit = 0.9;
  bool start_fits = true;
  bool drives_on = false;  ///< by its wheels
  bool flickers = false;   ///< its scans have noise
  Timestamp now = kStart;
};

struct Row {
  StopReason reason;
  std::function<void(Drive&)> begins;
  std::function<void(Drive&)> is_over;
  bool waits_for_person;
  bool brakes_hard;
};

std::vector<Row> table() {
  using Do = std::function<void(Drive&)>;
  const auto pose = [](LocalizerState state, PoseVerdict verdict) -> Do {
    return [=](Drive& d) {
      d.estimate = Estimate{};
      d.estimate->state = state;
      d.estimate->belief.verdict = verdict;
    };
  };
  const auto on_pose = [=](const Do& change) -> Do {
    return [=](Drive& d) {
      pose(LocalizerState::kTracking, PoseVerdict::kUndecided)(d);
      change(d);
    };
  };
  const auto all_beams = [](BeamKind kind) -> Do {
    return [=](Drive& d) {
      for (Beam& beam : d.scan.beams) beam.kind = kind;
    };
  };
  const Do looks_ahead = [](Drive& d) { d.scan.robot_from_laser = {}; };
  const Do tracked = pose(LocalizerState::kTracking, PoseVerdict::kUndecided);
  const auto right = PoseVerdict::kRight;
  const auto infinite = std::numeric_limits<double>::infinity();
  return {
      {StopReason::kNoCommand, [](Drive& d) { d.pilot_speaks = false, d.safety.release(); },
       [](Drive& d) { d.pilot_speaks = true; }, false, false},
      {StopReason::kCommandExpired, [](Drive& d) { d.pilot_speaks = false; }, [](Drive& d) { d.pilot_speaks = true; },
       false, false},
      {StopReason::kNoOdometry, [](Drive& d) { d.robot_speaks = false; }, [](Drive& d) { d.robot_speaks = true; },
       false, false},
      {StopReason::kNoWatchdog, [=](Drive& d) { d.safety.set_stopping_behaviour({.watchdog_s = infinite}); },
       [](Drive& d) { d.safety.set_stopping_behaviour({.watchdog_s = 2.0}); }, false, false},
      {StopReason::kWatchdogUnknown, [](Drive& d) { d.safety.set_stopping_behaviour({}); },
       [](Drive& d) { d.safety.set_stopping_behaviour({.watchdog_s = 2.0}); }, false, false},
      {StopReason::kStopButton, [](Drive& d) { d.odometry.stop_button = true; },
       [](Drive& d) { d.odometry.stop_button = false; }, false, false},
      {StopReason::kMotorsOff, [](Drive& d) { d.odometry.motors_enabled = false; },
       [](Drive& d) { d.odometry.motors_enabled = true; }, false, false},
      {StopReason::kBumper, [](Drive& d) { d.odometry.front_bumpers = 4; },
       [](Drive& d) { d.odometry.front_bumpers = 0; }, true, true},
      {StopReason::kBumper, [](Drive& d) { d.odometry.rear_bumpers = 1; },
       [](Drive& d) { d.odometry.rear_bumpers = 0; }, true, true},
      {StopReason::kStalled, [](Drive& d) { d.odometry.stalled = true; }, [](Drive& d) { d.odometry.stalled = false; },
       true, true},
      {StopReason::kControllerFault, [](Drive& d) { d.odometry.fault_flags = 0x0100; },
       [](Drive& d) { d.odometry.fault_flags = 0; }, true, false},
      {StopReason::kLowBattery, [](Drive& d) { d.odometry.low_battery = true; },
       [](Drive& d) { d.odometry.low_battery = false; }, true, false},
      {StopReason::kStaleLaser, [](Drive& d) { d.laser_speaks = false; }, [](Drive& d) { d.laser_speaks = true; },
       false, false},
      {StopReason::kLaserError, [](Drive& d) { d.scan.severity = 4; }, [](Drive& d) { d.scan.severity = 0; }, true,
       false},
      {StopReason::kLaserError, [](Drive& d) { d.scan.severity = 3; }, [](Drive& d) { d.scan.severity = 2; }, true,
       false},
      {StopReason::kImplausible, [](Drive& d) { d.scan.implausible = true; },
       [](Drive& d) { d.scan.implausible = false; }, false, false},
      {StopReason::kImplausible,
       [](Drive& d) {
         d.scan.beams.assign(181, {5.0F, 0.0F, BeamKind::kRange});
       },
       [](Drive& d) { d.flicker(); }, false, false},
      {StopReason::kPoseUnknown, pose(LocalizerState::kGlobal, right), tracked, false, false},
      {StopReason::kLost, pose(LocalizerState::kLost, right), tracked, false, false},
      {StopReason::kPoseWrong, pose(LocalizerState::kTracking, PoseVerdict::kWrong), tracked, false, false},
      {StopReason::kStartUnfit, on_pose([](Drive& d) { d.start_fits = false; }), [](Drive& d) { d.start_fits = true; },
       false, false},
      {StopReason::kPoseUnsure, on_pose([](Drive& d) { d.estimate->covariance(1, 1) = 1.1 * 1.1; }), tracked, false,
       false},
      {StopReason::kPoseUnfit, on_pose([](Drive& d) { d.fit = 0.1; }), [](Drive& d) { d.fit = 0.9; }, false, false},
      {StopReason::kUnknownRobot, [](Drive& d) { d.safety.set_unknown_robot(true); },
       [](Drive& d) { d.safety.set_unknown_robot(false); }, false, false},
      {StopReason::kCharging, [](Drive& d) { d.odometry.charging = true; },
       [](Drive& d) { d.odometry.charging = false; }, false, false},
      {StopReason::kNoBattery, [](Drive& d) { d.odometry.battery_v = 0.0; },
       [](Drive& d) { d.odometry.battery_v = 12.5; }, false, false},
      {StopReason::kLaserBlind, all_beams(BeamKind::kBeyondMaximum), all_beams(BeamKind::kRange), false, false},
      {StopReason::kLaserBlind, all_beams(BeamKind::kNotValid), all_beams(BeamKind::kRange), false, false},
      {StopReason::kLaserFrozen, [](Drive& d) { d.drives_on = true; },
       [](Drive& d) { d.drives_on = false, d.flicker(); }, false, false},
      {StopReason::kWayUncovered, [](Drive& d) { d.scan.robot_from_laser.theta = std::numbers::pi; }, looks_ahead,
       false, false},
      {StopReason::kWayUncovered, [](Drive& d) { d.scan.robot_from_laser.theta = -std::numbers::pi / 2.0; },
       looks_ahead, false, false},
      {StopReason::kWheelsSpin, [](Drive& d) { d.drives_on = true, d.flickers = true; },
       [](Drive& d) { d.drives_on = false; }, true, true},
      {StopReason::kDisobeys, [](Drive& d) { d.is_told = true, d.odometry.speed_m_per_s = 0.9; },
       [](Drive& d) { d.odometry.speed_m_per_s = 0.0; }, true, true},
      {StopReason::kReverse, [](Drive& d) { d.speed_m_per_s = -0.1; }, [](Drive& d) { d.speed_m_per_s = 0.3; }, false,
       false},
      {StopReason::kBlockedZone,
       [](Drive& d) {
         d.safety.heed({.time = d.now, .blocked_in_robot = {{0.3, 0.0}}});
       },
       [](Drive& d) { d.safety.heed({}); }, false, false},
      {StopReason::kObstacle, [](Drive& d) { d.scan.beams[90].range_m = 0.3F; },
       [](Drive& d) { d.scan.beams[90].range_m = 6.0F; }, false, false},
  };
}

constexpr double kLongEnoughS = 4.0;  // for whatever counts time: a low battery, plausible scans

TEST(StopReasons, EachStopsTheRobotAndEndsAsItsRowSays) {
  for (const Row& row : table()) {
    SCOPED_TRACE(name_of(row.reason));
    Drive drive;
    ASSERT_EQ(drive.run_for(1.0).stop, StopReason::kNone);
    row.begins(drive);
    const AllowedMotion motion = drive.run_for(kLongEnoughS);
    EXPECT_EQ(motion.stop, row.reason) << name_of(motion.stop);
    EXPECT_EQ(motion.speed_m_per_s, 0.0);
    EXPECT_EQ(motion.brake_hard, row.brakes_hard);
    EXPECT_EQ(waits_for_person(row.reason), row.waits_for_person);
    drive.safety.let_drive_again();
    EXPECT_EQ(drive.run_for(kLongEnoughS).stop, row.reason) << "while the cause is there, nobody can drive";
    row.is_over(drive);
    const StopReason after = drive.run_for(kLongEnoughS).stop;
    EXPECT_EQ(after, row.waits_for_person ? row.reason : StopReason::kNone) << name_of(after);
    drive.safety.let_drive_again();
    EXPECT_EQ(drive.tick().stop, StopReason::kNone);
  }
}

TEST(StopReasons, AllWithoutWhatLiesAheadForbidTurningAsWell) {
  for (const Row& row : table()) {
    Drive drive;
    row.begins(drive);
    const AllowedMotion motion = drive.run_for(kLongEnoughS);
    const bool is_ahead = row.reason == StopReason::kObstacle || row.reason == StopReason::kBlockedZone;
    EXPECT_EQ(motion.turn_rate_rad_per_s, is_ahead ? 0.1 : 0.0) << name_of(row.reason);
  }
}

TEST(StopReasons, HaveEachTheirOwnNameAndTheirRow) {
  std::vector<std::string_view> names;
  for (auto reason = StopReason::kNoCommand; reason <= StopReason::kObstacle;
       reason = static_cast<StopReason>(static_cast<int>(reason) + 1)) {
    EXPECT_EQ(std::count(names.begin(), names.end(), name_of(reason)), 0) << name_of(reason);
    EXPECT_NE(name_of(reason), "unknown");
    names.push_back(name_of(reason));
    const auto rows = table();
    EXPECT_TRUE(std::any_of(rows.begin(), rows.end(), [&](const Row& row) { return row.reason == reason; }))
        << name_of(reason) << " has no row";
  }
}

TEST(StopReasons, ThatWaitForAPersonEndWithTheMotorsButtonOffAndOn) {
  for (const Row& row : table()) {
    if (!row.waits_for_person) continue;
    SCOPED_TRACE(name_of(row.reason));
    Drive drive;
    (void)drive.run_for(1.0);
    row.begins(drive);
    (void)drive.run_for(kLongEnoughS);
    drive.press_motors_button();
    EXPECT_EQ(drive.run_for(kLongEnoughS).stop, row.reason) << "the cause was still there";
    row.is_over(drive);
    EXPECT_EQ(drive.run_for(1.0).stop, row.reason);
    drive.press_motors_button();
    EXPECT_EQ(drive.run_for(1.0).stop, StopReason::kNone);
  }
}

TEST(StopReasons, DoNotEndWhenTheMotorsComeOnAfterAReconnect) {
  Drive drive;
  (void)drive.run_for(1.0);
  drive.odometry.front_bumpers = 1;
  (void)drive.run_for(0.5);
  drive.odometry.front_bumpers = 0;
  drive.odometry.motors_enabled = false;  // reset: another epoch, and the daemon enables them
  ++drive.odometry.epoch;
  (void)drive.run_for(1.0);
  drive.odometry.motors_enabled = true;
  EXPECT_EQ(drive.run_for(1.0).stop, StopReason::kBumper);
}

/// What a robot may be told and not do: silence and motors that are off ask nothing of it.
bool asks_nothing_of_the_robot(StopReason reason) {
  return reason == StopReason::kNoOdometry || reason == StopReason::kMotorsOff;
}

TEST(StopReasons, NoneHidesThatTheRobotDoesNotObeyNorWithdrawsItsHardestBraking) {
  const auto run_away = [](Drive& drive) { drive.odometry.speed_m_per_s = 0.9; };
  for (const Row& row : table()) {
    SCOPED_TRACE(name_of(row.reason));
    Drive stops_first;
    stops_first.is_told = true;
    Drive runs_away_first = stops_first;
    row.begins(stops_first);
    (void)stops_first.run_for(kLongEnoughS);
    run_away(stops_first);
    const AllowedMotion motion = stops_first.run_for(kLongEnoughS);
    EXPECT_EQ(motion.stop == StopReason::kDisobeys, !asks_nothing_of_the_robot(row.reason)) << name_of(motion.stop);
    EXPECT_TRUE(motion.brake_hard || asks_nothing_of_the_robot(row.reason));

    (void)runs_away_first.run_for(1.0);
    run_away(runs_away_first);
    ASSERT_EQ(runs_away_first.run_for(2.0).stop, StopReason::kDisobeys);
    row.begins(runs_away_first);
    for (double t = 0.0; t < kLongEnoughS; t += kTickS) {
      const AllowedMotion still = runs_away_first.tick();
      EXPECT_EQ(name_of(still.stop), name_of(StopReason::kDisobeys));
      EXPECT_TRUE(still.brake_hard);
    }
  }
}

TEST(StopReasons, BrakeHardWhateverIsNamedWhereSomethingWasTouched) {
  for (const Row& row : table()) {
    if (!row.brakes_hard) continue;
    for (const Row& other : table()) {
      SCOPED_TRACE(std::string(name_of(row.reason)) + " after " + std::string(name_of(other.reason)));
      Drive drive;
      drive.is_told = true;
      row.begins(drive);
      (void)drive.run_for(kLongEnoughS);
      other.begins(drive);
      EXPECT_TRUE(drive.run_for(kLongEnoughS).brake_hard);
    }
  }
}

TEST(StopReasons, BumperOfOneSipIsEnough) {
  Drive drive;
  (void)drive.run_for(1.0);
  drive.odometry.front_bumpers = 1;
  EXPECT_TRUE(drive.tick().brake_hard);
  drive.odometry.front_bumpers = 0;
  EXPECT_EQ(drive.run_for(60.0).stop, StopReason::kBumper);
}

TEST(StopReasons, LowBatteryIsMoreThanTheSagOfAMotorThatStarts) {
  Drive drive;
  drive.odometry.low_battery = true;
  EXPECT_EQ(drive.run_for(2.0).stop, StopReason::kNone);
  drive.odometry.low_battery = false;
  EXPECT_EQ(drive.tick().stop, StopReason::kNone);
  drive.odometry.low_battery = true;
  EXPECT_EQ(drive.run_for(2.0).stop, StopReason::kNone) << "counted anew";
  EXPECT_EQ(drive.run_for(2.0).stop, StopReason::kLowBattery);
}

TEST(StopReasons, ImplausibleScanKeepsItStandingForAWhile) {
  Drive drive;
  drive.scan.implausible = true;
  EXPECT_EQ(drive.tick().stop, StopReason::kImplausible);
  drive.scan.implausible = false;
  EXPECT_EQ(drive.run_for(1.5).stop, StopReason::kImplausible);
  EXPECT_EQ(drive.run_for(1.0).stop, StopReason::kNone);
  for (std::size_t i = 40; i < 131; ++i) drive.scan.beams[i].range_m = 5.0F;
  EXPECT_EQ(drive.tick().stop, StopReason::kImplausible) << "a quarter turn of one range, at the first scan";
}

TEST(StopReasons, WarningsOfTheLaserAreNone) {
  Drive drive;
  drive.scan.severity = 2;  // the front window is dirty
  EXPECT_EQ(drive.run_for(1.0).stop, StopReason::kNone);
}

TEST(StopReasons, AreNoneForAMisfitWhereWheelsAndScansHaveCarriedThePoseOn) {
  Drive drive;
  drive.estimate = Estimate{};
  drive.estimate->state = LocalizerState::kTracking;
  drive.estimate->belief.is_carried = true;
  drive.fit = 0.05;
  EXPECT_EQ(drive.run_for(10.0).stop, StopReason::kNone);
  drive.estimate->belief.is_carried = false;
  EXPECT_EQ(drive.run_for(3.0).stop, StopReason::kPoseUnfit);
  drive.estimate->belief.is_carried = true;
  EXPECT_EQ(drive.run_for(3.0).stop, StopReason::kPoseUnfit) << "once it is unfit, a fit alone ends it";
  drive.fit = 0.9;
  EXPECT_EQ(drive.run_for(3.0).stop, StopReason::kNone);
}

}  // namespace
}  // namespace deltamap::navigation
