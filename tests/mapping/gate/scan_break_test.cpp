// SPDX-License-Identifier: Apache-2.0
// When a scan does not follow from the one before, and what the gate makes of it.
#include "mapping/gate/scan_break.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "mapping/gate/write_gate.hpp"
#include "tests/mapping/straight_drive.hpp"

namespace deltamap::mapping::gate {
namespace {

/// What a laser of 180 beams sees in an aisle 3 m wide: niches 1 m deep stand 2 m apart, every third one is walled up.
/// A thing stands 1 m away across so many beams.
TrackedScan aisle_scan(StraightDrive& robot, double carried_m, int thing_beams = 0) {
  TrackedScan tracked = robot.next();
  const double x = tracked.odom_from_robot.x + carried_m;
  tracked.scan.first_bearing_rad = -0.5 * std::numbers::pi;
  tracked.scan.bearing_step_rad = radians(1.0);
  const auto is_wall = [](double along, double aside) {
    if (std::abs(aside) < 1.5) return along > 60.0;
    const double place = std::floor(0.5 * along);
    const bool niche = std::fmod(along + 100.0, 2.0) < 1.0 && std::fmod(place + 300.0, aside > 0.0 ? 3.0 : 5.0) >= 1.0;
    return !niche || std::abs(aside) >= 2.5;
  };
  for (int i = 0; i < 180; ++i) {
    const double bearing_rad = tracked.scan.bearing_rad(static_cast<std::size_t>(i));
    const Point2 along{std::cos(bearing_rad), std::sin(bearing_rad)};
    double range_m = 0.05;
    while (range_m < 30.0 && !is_wall(x + range_m * along.x(), range_m * along.y())) range_m += 0.02;
    if (i >= 90 && i < 90 + thing_beams) range_m = std::min(range_m, 1.0);
    tracked.scan.beams.push_back({static_cast<float>(range_m), 0.0F, BeamKind::kRange});
    tracked.rays.push_back({{0.0F, 0.0F}, (range_m * along).cast<float>()});
  }
  tracked.estimate.belief.elsewhere = {.expected = 100, .fit = 95, .short_of = 5};
  return tracked;
}

TEST(ScanBreak, IsNoneWhereTheRobotDrivesOnItsOwnWheels) {
  StraightDrive robot;
  ScanBreak scans{{.most = 0.08, .most_one_way = 0.08}};
  for (int i = 0; i < 300; ++i) ASSERT_FALSE(scans.observe(aisle_scan(robot, 0.0))) << i;
}

TEST(ScanBreak, IsSeenInTheFirstScanOfACarriedRobot) {
  StraightDrive robot;
  ScanBreak scans{{}};
  for (int i = 0; i < 20; ++i) ASSERT_FALSE(scans.observe(aisle_scan(robot, 0.0)));
  EXPECT_TRUE(scans.observe(aisle_scan(robot, 2.5)));
  EXPECT_FALSE(scans.observe(aisle_scan(robot, 2.5)));
}

TEST(ScanBreak, IsNoneWhereAThingComesOrGoes) {
  StraightDrive robot;
  ScanBreak scans{{}};
  for (int i = 0; i < 20; ++i) (void)scans.observe(aisle_scan(robot, 0.0));
  for (const int thing_beams : {45, 45, 0}) EXPECT_FALSE(scans.observe(aisle_scan(robot, 0.0, thing_beams)));
}

TEST(ScanBreak, IsOneWhereAThirdOfTheViewIsNearer) {
  StraightDrive robot;
  ScanBreak scans{{}};
  for (int i = 0; i < 20; ++i) (void)scans.observe(aisle_scan(robot, 0.0));
  EXPECT_TRUE(scans.observe(aisle_scan(robot, 0.0, 70)));
}

TEST(ScanBreak, IsNoneWhereTheWheelsHaveSlippedAndTheEstimateHasNot) {
  StraightDrive robot;
  ScanBreak scans{{.most = 0.08, .most_one_way = 0.08}};
  for (int i = 0; i < 20; ++i) (void)scans.observe(aisle_scan(robot, 0.0));
  robot.map_from_odom.x = -0.6;  // so much the wheels counted and the body did not go
  for (int i = 0; i < 20; ++i) ASSERT_FALSE(scans.observe(aisle_scan(robot, -0.6))) << i;
}

TEST(ScanBreak, IsOneAfterAWayWithoutScansOverWhichTheWheelsMayBeOff) {
  StraightDrive robot;
  ScanBreak scans{{}};
  (void)scans.observe(aisle_scan(robot, 0.0));
  robot.speed_m_per_s = 2.0 / kPeriod_s;
  EXPECT_FALSE(scans.observe(aisle_scan(robot, 0.0)));
  robot.speed_m_per_s = 4.0 / kPeriod_s;
  EXPECT_TRUE(scans.observe(aisle_scan(robot, 0.0)));
}

TEST(WriteGate, ABreakOfTheScansShutsItForAMomentWhereTheMapStillFits) {
  StraightDrive robot;
  WriteGate gate{{}};
  for (int i = 0; i < 100; ++i) gate.observe(aisle_scan(robot, 0.0));
  ASSERT_TRUE(gate.is_open());
  gate.observe(aisle_scan(robot, 2.5));
  EXPECT_EQ(gate.reason(), GateReason::kConfirming);
  for (int i = 0; i < 12; ++i) gate.observe(aisle_scan(robot, 2.5));
  EXPECT_TRUE(gate.is_open());
  EXPECT_FALSE(gate.trusted_since());  // nothing has proven wrong
}

TEST(WriteGate, ACarriedRobotWritesNothingUntilAsMuchFitsAsBefore) {
  StraightDrive robot;
  WriteGate gate{{}};
  for (int i = 0; i < 120; ++i) gate.observe(aisle_scan(robot, 0.0));
  const auto carried = [&](std::uint32_t fit) {
    TrackedScan tracked = aisle_scan(robot, 2.5);
    tracked.estimate.belief.elsewhere = {.expected = 100, .fit = fit, .beyond = 100 - fit};
    gate.observe(tracked);
  };
  for (int i = 0; i < 400; ++i) {
    carried(50);  // long past usual: the localizer goes on believing in its pose
    ASSERT_FALSE(gate.is_open()) << i;
  }
  for (int i = 0; i < 75; ++i) {
    carried(95);
    ASSERT_FALSE(gate.is_open()) << i;
  }
  for (int i = 0; i < 20; ++i) carried(95);
  EXPECT_TRUE(gate.is_open());
}

TEST(WriteGate, ARobotThatIsCarriedWhileItsPoseIsConfirmedBeginsAnew) {
  StraightDrive robot;
  WriteGate gate{{}};
  for (int i = 0; i < 120; ++i) gate.observe(aisle_scan(robot, 0.0));
  TrackedScan disbelieved = aisle_scan(robot, 0.0);
  disbelieved.estimate.belief.pose_right = 0.2;
  gate.observe(disbelieved);
  for (int i = 0; i < 75; ++i) gate.observe(aisle_scan(robot, 0.0));
  for (int i = 0; i < 75; ++i) {
    gate.observe(aisle_scan(robot, 2.5));
    ASSERT_FALSE(gate.is_open()) << i;
  }
  for (int i = 0; i < 15; ++i) gate.observe(aisle_scan(robot, 2.5));
  EXPECT_TRUE(gate.is_open());
}

/// Of 100 beams that the map expects to end somewhere.
TrackedScan fitting(TrackedScan tracked, std::uint32_t fit, std::uint32_t short_of) {
  tracked.estimate.belief.elsewhere = {
      .expected = 100, .fit = fit, .short_of = short_of, .beyond = 100 - fit - short_of};
  return tracked;
}

/// Where the map is out of date anyway, a bad fit alone says nothing.
class OutOfDate : public testing::Test {
 protected:
  void SetUp() override {
    for (int i = 0; i < 200; ++i) gate.observe(fitting(aisle_scan(robot, 0.0), 80, 10));
    ASSERT_TRUE(gate.is_open());
  }
  StraightDrive robot;
  WriteGate gate{{}};
};

TEST_F(OutOfDate, AThingThatComesLeavesTheGateOpen) {
  for (int i = 0; i < 100; ++i) {
    gate.observe(fitting(aisle_scan(robot, 0.0, 45), 50, 40));
    ASSERT_TRUE(gate.is_open()) << i;
  }
}

TEST_F(OutOfDate, AHallThatIsMoreAndMoreOutOfDateLeavesTheGateOpen) {
  for (int i = 0; i < 100; ++i) {
    gate.observe(fitting(aisle_scan(robot, 0.0), 30, 10));
    ASSERT_TRUE(gate.is_open()) << i;
  }
}

TEST_F(OutOfDate, AWorseFitSoonAfterABreakIsACarriedRobot) {
  for (int i = 0; i < 30; ++i) gate.observe(fitting(aisle_scan(robot, 2.5), 80, 10));
  ASSERT_TRUE(gate.is_open());
  for (int i = 0; i < 15; ++i) gate.observe(fitting(aisle_scan(robot, 2.5), 30, 10));
  EXPECT_EQ(gate.reason(), GateReason::kConfirming);
}

TEST_F(OutOfDate, AWorseFitLongAfterABreakSaysNothing) {
  for (int i = 0; i < 70; ++i) gate.observe(fitting(aisle_scan(robot, 2.5), 80, 10));
  for (int i = 0; i < 50; ++i) {
    gate.observe(fitting(aisle_scan(robot, 2.5), 30, 10));
    ASSERT_TRUE(gate.is_open()) << i;
  }
}

}  // namespace
}  // namespace deltamap::mapping::gate
