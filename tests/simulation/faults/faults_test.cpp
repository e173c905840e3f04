// SPDX-License-Identifier: Apache-2.0
// Faults on order, as the sessions of the real devices see them: each does what its name says and ends without a trace.
#include "simulation/faults/faults.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "simulation/faults/named_fault.hpp"
#include "tests/simulation/simulation_host.hpp"

namespace deltamap::simulation {
namespace {

namespace pioneer = drivers::pioneer;
using Answer = LaserFaults::Answer;

constexpr double kConnecting_s = 12.0;
constexpr double kRounding_m = 0.02;  // of a range to the wire's centimetre, and of its noise

/// A hall 12 m long with a robot in it whose wheels and laser make no errors.
Scenario empty_hall(double x_m = 5.0) {
  Scenario scenario = parse_scenario("walls:\n  - [[0, 0], [12, 0], [12, 10], [0, 10], [0, 0]]\nrobot: {start: [" +
                                         std::to_string(x_m) +
                                         ", 4, 0], track_error: 0, left_wheel_error: 0, right_wheel_error: 0, "
                                         "wheel_noise_m_per_sqrt_m: 0, slips_per_m: 0}\n"
                                         "laser: {range_noise_m: 0.001, dropout_share: 0, mixed_share: 0}\n",
                                     "hall");
  return scenario;
}

struct Drive {
  explicit Drive(const Scenario& scenario = empty_hall()) : host{scenario, 3} { host.run_for(kConnecting_s); }

  struct Ways {
    double body_m;      ///< ahead
    double wheels_m;    ///< ahead
    double body_rad;    ///< counter-clockwise
    double wheels_rad;  ///< counter-clockwise
    std::vector<Scan> scans;
  };
  /// What the body did, what its wheels told, and what the laser saw.
  Ways run(double seconds) {
    const Pose2 before = host.simulation.map_from_robot();
    const Odometry told_before = host.odometry.back();
    const std::size_t scans_before = host.scans.size();
    host.run_for(seconds);
    const Pose2 moved = motion_between(before, host.simulation.map_from_robot());
    const Pose2 told = motion_between(told_before.odom_from_robot, host.odometry.back().odom_from_robot);
    return {moved.x,
            told.x,
            moved.theta,
            told.theta,
            {host.scans.begin() + static_cast<std::ptrdiff_t>(scans_before), host.scans.end()}};
  }
  Faults& faults() { return host.simulation.faults(); }

  Host host;
};

double range_at(const Scan& scan, double bearing_deg) {
  const double index = (radians(bearing_deg) - scan.first_bearing_rad) / scan.bearing_step_rad;
  const Beam& beam = scan.beams.at(static_cast<std::size_t>(std::lround(index)));
  return beam.kind == BeamKind::kRange ? static_cast<double>(beam.range_m) : -1.0;
}

bool all_are(const Scan& scan, BeamKind kind) {
  return std::all_of(scan.beams.begin(), scan.beams.end(), [kind](const Beam& beam) { return beam.kind == kind; });
}

bool same_ranges(const Scan& a, const Scan& b) {
  return std::equal(a.beams.begin(), a.beams.end(), b.beams.begin(), b.beams.end(),
                    [](const Beam& x, const Beam& y) { return x.kind == y.kind && x.range_m == y.range_m; });
}

TEST(LaserFaults, RepeatsOneScanWhileTelegramsAndTimesGoOn) {
  Drive drive;
  drive.host.drive(0.3, 0.0);
  (void)drive.run(2.0);
  drive.faults().laser.answer = Answer::kRepeated;
  (void)drive.run(0.5);  // what was measured before is on the line
  const auto repeated = drive.run(4.0).scans;
  ASSERT_GT(repeated.size(), 10u);
  for (std::size_t i = 1; i < repeated.size(); ++i) {
    EXPECT_TRUE(same_ranges(repeated[0], repeated[i]));
    EXPECT_GT(repeated[i].time, repeated[i - 1].time);
    EXPECT_EQ(repeated[i].number, repeated[i - 1].number + 1);
  }
  drive.faults() = {};
  (void)drive.run(0.5);
  const auto measured = drive.run(1.0).scans;
  EXPECT_FALSE(same_ranges(measured.front(), measured.back()));
}

TEST(LaserFaults, AnswersAllBeamsAlike) {
  Drive drive;
  for (const auto& [answer, kind] :
       {std::pair{Answer::kBeyondMaximum, BeamKind::kBeyondMaximum}, std::pair{Answer::kNotValid, BeamKind::kNotValid},
        std::pair{Answer::kDazzled, BeamKind::kDazzled}, std::pair{Answer::kConstant, BeamKind::kRange}}) {
    drive.faults().laser = {.answer = answer, .constant_m = 2.5};
    (void)drive.run(0.5);
    const auto scans = drive.run(1.0).scans;
    ASSERT_FALSE(scans.empty());
    EXPECT_TRUE(all_are(scans.back(), kind));
    EXPECT_NEAR(range_at(scans.back(), -40), kind == BeamKind::kRange ? 2.5 : -1.0, 1e-6);
  }
  drive.faults() = {};
  (void)drive.run(0.5);
  EXPECT_NEAR(range_at(drive.run(1.0).scans.back(), 0), 7.0 - 0.021, kRounding_m);
}

TEST(LaserFaults, DrawsARangeForEachBeam) {
  Drive drive;
  drive.faults().laser = {.answer = Answer::kRandom, .random_most_m = 4.0};
  (void)drive.run(0.5);
  const auto scans = drive.run(1.0).scans;
  double sum_m = 0.0;
  for (const Beam& beam : scans.back().beams) {
    EXPECT_LE(beam.range_m, 4.0F);
    sum_m += static_cast<double>(beam.range_m);
  }
  EXPECT_NEAR(sum_m / static_cast<double>(scans.back().beams.size()), 2.0, 0.3);
  EXPECT_FALSE(same_ranges(scans.front(), scans.back()));
}

TEST(LaserFaults, LooksWhereItWasTurnedTo) {
  Drive drive;
  const Scan right_way = drive.run(1.0).scans.back();
  EXPECT_NEAR(range_at(right_way, 0), 7.0 - 0.021, kRounding_m);
  EXPECT_NEAR(range_at(right_way, 90), 6.0, kRounding_m);
  drive.faults().laser.turned_rad = radians(180.0);
  (void)drive.run(0.5);
  const Scan backwards = drive.run(1.0).scans.back();
  EXPECT_NEAR(range_at(backwards, 0), 5.0 + 0.021, kRounding_m);
  EXPECT_NEAR(range_at(backwards, 90), 4.0, kRounding_m);
  drive.faults().laser = {.turned_rad = radians(90.0)};
  (void)drive.run(0.5);
  EXPECT_NEAR(range_at(drive.run(1.0).scans.back(), 0), 6.0, kRounding_m);
  drive.faults().laser = {.upside_down = true};
  (void)drive.run(0.5);
  EXPECT_NEAR(range_at(drive.run(1.0).scans.back(), 90), 4.0, kRounding_m) << "its left is its right";
}

TEST(LaserFaults, CoversAPartOfTheFanAndScalesTheRest) {
  Drive drive;
  drive.faults().laser = {.scale = 0.9, .covered_from_rad = radians(-30.0), .covered_to_rad = radians(20.0)};
  (void)drive.run(0.5);
  const Scan scan = drive.run(1.0).scans.back();
  for (const double covered_deg : {-30.0, 0.0, 19.5}) EXPECT_LT(range_at(scan, covered_deg), 0.0);
  EXPECT_NEAR(range_at(scan, 90), 0.9 * 6.0, kRounding_m);
  EXPECT_NEAR(range_at(scan, -90), 0.9 * 4.0, kRounding_m);
}

TEST(LaserFaults, SeesFromAnotherPlaceWithItsUsualNoise) {
  Drive drive;
  drive.faults().laser.moved_on_map = {2.0, 0.0, radians(90.0)};
  (void)drive.run(0.5);
  const Scan elsewhere = drive.run(1.0).scans.back();
  EXPECT_NEAR(range_at(elsewhere, 0), 6.0 - 0.021, kRounding_m) << "a quarter turn to the left";
  EXPECT_NEAR(range_at(elsewhere, 90), 7.0, kRounding_m) << "2 m farther on";
  drive.faults().laser = {.sees_from_where_it_began = true};
  (void)drive.run(0.5);
  drive.host.drive(0.4, 0.0);
  const auto standing = drive.run(5.0);
  EXPECT_GT(standing.body_m, 1.0);
  EXPECT_NEAR(range_at(standing.scans.back(), 0), 7.0 - 0.021, kRounding_m);
  EXPECT_FALSE(same_ranges(standing.scans.front(), standing.scans.back())) << "noise";
  drive.faults() = {};
  (void)drive.run(0.5);
  EXPECT_LT(range_at(drive.run(1.0).scans.back(), 0), 6.0);
}

TEST(BodyFaults, LetsWheelsSpinWhileTheBodyStands) {
  Drive drive;
  drive.faults().body.left_grip = drive.faults().body.right_grip = 0.0;
  drive.host.drive(0.4, 0.0);
  const auto spun = drive.run(8.0);
  EXPECT_GT(spun.wheels_m, 2.0);
  EXPECT_NEAR(spun.body_m, 0.0, 1e-9);
  EXPECT_FALSE(drive.host.odometry.back().stalled);
  drive.faults() = {};
  EXPECT_GT(drive.run(2.0).body_m, 0.5);
}

TEST(BodyFaults, TurnsAboutTheWheelThatSpins) {
  for (const bool left : {true, false}) {
    Drive drive;
    (left ? drive.faults().body.left_grip : drive.faults().body.right_grip) = 0.0;
    drive.host.drive(0.1, 0.0);
    const auto turned = drive.run(3.0);
    EXPECT_NEAR(turned.wheels_rad, 0.0, 0.01);
    EXPECT_GT(left ? turned.body_rad : -turned.body_rad, 0.3);
  }
}

TEST(BodyFaults, SlipsShortAndFar) {
  for (const double grip : {0.5, 1.5}) {
    Drive drive;
    drive.faults().body.left_grip = drive.faults().body.right_grip = grip;
    drive.host.drive(0.3, 0.0);
    const auto slipped = drive.run(6.0);
    EXPECT_NEAR(slipped.body_m, grip * slipped.wheels_m, 0.06) << "a SIP is up to 0.1 s old";
  }
}

TEST(BodyFaults, BlocksTheWheelsWithoutAStall) {
  Drive drive;
  drive.host.drive(0.3, 0.0);
  (void)drive.run(2.0);
  drive.faults().body.wheels_blocked = true;
  (void)drive.run(0.3);
  const auto blocked = drive.run(4.0);
  EXPECT_EQ(blocked.body_m, 0.0);
  EXPECT_EQ(blocked.wheels_m, 0.0);
  EXPECT_FALSE(drive.host.odometry.back().stalled);
  EXPECT_TRUE(drive.host.odometry.back().motors_enabled);
}

TEST(BodyFaults, MovesWithoutItsMotors) {
  Drive drive;
  drive.host.simulation.robot().press_stop_button();
  drive.faults().body.towed_per_s = {0.3, 0.0, radians(5.0)};
  const auto towed = drive.run(4.0);
  EXPECT_GT(towed.body_m, 1.0);
  EXPECT_NEAR(towed.body_rad, radians(20.0), 0.01);
  EXPECT_EQ(towed.wheels_m, 0.0);
  drive.faults().body = {.pushed_m_per_s = 0.3};
  const auto pushed = drive.run(4.0);
  EXPECT_NEAR(pushed.body_m, 1.2, 0.01);
  EXPECT_NEAR(pushed.wheels_m, 1.2, 0.05);
  const Pose2 there{9.0, 5.0, 0.0};
  drive.faults() = {};
  (void)drive.run(2.0);  // it rolls out
  drive.host.simulation.carry_robot_to(there);
  EXPECT_EQ(drive.run(1.0).wheels_m, 0.0);
  EXPECT_EQ(drive.host.simulation.map_from_robot(), there);
}

TEST(ControllerFaults, DrivesOnWhateverItIsToldUntilEstop) {
  Drive drive;
  const auto disobeys = [&](const char* how) {
    drive.host.drive(0.0, 0.0);
    EXPECT_GT(drive.run(3.0).body_m, 0.8) << how;
    EXPECT_GT(drive.host.odometry.back().speed_m_per_s, 0.35) << how << ": its encoders tell";
    drive.host.emergency_stop();
    (void)drive.run(0.5);
    EXPECT_NEAR(drive.run(1.0).body_m, 0.0, 1e-9) << how << ": ESTOP is heeded";
  };
  drive.host.drive(0.4, 0.0);
  (void)drive.run(2.0);
  drive.faults().controller.keeps_set_points = true;
  disobeys("keeps its set points");
  drive.faults().controller = {.goes_at_m_per_s = 0.4};
  drive.host.drive(0.1, 0.0);  // an ESTOP ends where the robot is told to move
  disobeys("goes at a speed of its own");
}

TEST(ControllerFaults, DrivesFasterThanItIsTold) {
  Drive drive;
  drive.faults().controller.speed_factor = 2.0;
  drive.host.drive(0.2, 0.0);
  (void)drive.run(3.0);
  EXPECT_NEAR(drive.run(2.0).body_m, 0.8, 0.01);
  drive.faults() = {};
  (void)drive.run(3.0);
  EXPECT_NEAR(drive.run(2.0).body_m, 0.4, 0.01);
  drive.faults().controller.turns_at_rad_per_s = radians(30.0);
  drive.host.drive(0.0, 0.0);
  (void)drive.run(2.0);
  EXPECT_NEAR(drive.run(1.0).body_rad, radians(30.0), 0.02);
}

TEST(ControllerFaults, CountsInTheUnitsOfTheRobotThatItIs) {
  Drive drive{with_robot(empty_hall(), "p3at")};
  EXPECT_EQ(drive.host.robot_session.identity()->subtype, "p3at");
  drive.host.drive(0.4, 0.0);
  const auto way = drive.run(8.0);
  EXPECT_NEAR(way.wheels_m, way.body_m / 0.465, 0.2) << "taken for a p3dx-sh";
  EXPECT_THROW((void)with_robot(empty_hall(0.4), "p3at"), std::runtime_error) << "a hull of 0.5 m";
}

TEST(LaserFaults, TellsZeroOnAllBeamsAndNoneBecomesARange) {
  Drive drive;
  drive.faults().laser.answer = Answer::kZero;
  (void)drive.run(0.5);
  EXPECT_TRUE(all_are(drive.run(1.0).scans.back(), BeamKind::kNotValid));
}

TEST(BodyFaults, DrivesWithoutCountingIt) {
  Drive drive;
  drive.faults().body.counts_nothing = true;
  drive.host.drive(0.3, 0.0);
  const auto way = drive.run(4.0);
  EXPECT_GT(way.body_m, 0.8);
  EXPECT_EQ(way.wheels_m, 0.0);
  EXPECT_EQ(drive.host.odometry.back().speed_m_per_s, 0.0);
}

TEST(ControllerFaults, TellsButtonsStallsBumpersAndFaults) {
  Drive drive;
  drive.faults().controller = {.tells_stall = true, .front_bumpers = 4, .fault_flags = 0x21, .stop_button = true};
  (void)drive.run(1.0);
  const Odometry told = drive.host.odometry.back();
  EXPECT_TRUE(told.stalled);
  EXPECT_EQ(told.front_bumpers, 4);
  EXPECT_EQ(told.fault_flags, 0x21);
  EXPECT_FALSE(told.motors_enabled);
  EXPECT_TRUE(drive.host.robot_session.stop_button_is_pressed());
  drive.faults() = {};
  (void)drive.run(1.0);
  EXPECT_FALSE(drive.host.odometry.back().stalled || drive.host.odometry.back().front_bumpers != 0);
  EXPECT_FALSE(drive.host.robot_session.stop_button_is_pressed());
}

TEST(ControllerFaults, PressesTheMotorsButtonOnceAndCutsThePowerOnce) {
  Drive drive;
  ASSERT_TRUE(drive.host.simulation.robot().motors_enabled());
  ++drive.faults().controller.motors_button_presses;
  (void)drive.run(0.2);
  EXPECT_FALSE(drive.host.simulation.robot().motors_enabled());
  ++drive.faults().controller.resets;
  (void)drive.run(0.2);
  EXPECT_FALSE(drive.host.simulation.robot().is_connected());
}

TEST(Simulation, CountsEachCollisionOnceWithItsSpeed) {
  Drive drive{empty_hall(10.0)};
  drive.host.drive(0.4, 0.0);
  (void)drive.run(8.0);
  ASSERT_EQ(drive.host.simulation.collisions().size(), 1u) << "it pushes on and on against the same wall";
  EXPECT_NEAR(drive.host.simulation.collisions()[0].speed_m_per_s, 0.4, 0.01);
  EXPECT_NEAR(drive.host.simulation.collisions()[0].map_from_robot.x, 12.0 - 0.25, 0.01);
  drive.host.drive(-0.3, 0.0);
  (void)drive.run(4.0);
  drive.host.drive(0.2, 0.0);
  (void)drive.run(8.0);
  ASSERT_EQ(drive.host.simulation.collisions().size(), 2u) << "it went back and came again";
  EXPECT_NEAR(drive.host.simulation.collisions()[1].speed_m_per_s, 0.2, 0.01);
  const auto told = std::count_if(drive.host.truth.begin(), drive.host.truth.end(),
                                  [](const TruthRecord& record) { return std::holds_alternative<Collision>(record); });
  EXPECT_EQ(told, 2);
}

TEST(Simulation, CountsNoSpeedWhereTheRobotIsTowedIntoAWall) {
  Drive drive{empty_hall(10.0)};
  drive.faults().body.towed_per_s = {0.5, 0.0, 0.0};
  (void)drive.run(6.0);
  ASSERT_EQ(drive.host.simulation.collisions().size(), 1u);
  EXPECT_EQ(drive.host.simulation.collisions()[0].speed_m_per_s, 0.0);
  EXPECT_FALSE(drive.host.odometry.back().stalled) << "its motors are not asked for anything";
}

}  // namespace
}  // namespace deltamap::simulation
