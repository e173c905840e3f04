// SPDX-License-Identifier: Apache-2.0
#include "drivers/pioneer/odometry.hpp"

#include <gtest/gtest.h>

#include <numbers>
#include <vector>

namespace deltamap::drivers::pioneer {
namespace {

constexpr double kTolerance = 1e-9;
const RobotModel kSh = *model_named("p3dx-sh");

/// SIPs a tenth of a second apart.
class Drive {
 public:
  explicit Drive(const RobotModel& model = kSh) : tracker{model} {}

  Odometry at(int x_units, int y_units = 0, int heading_units = 0) {
    Sip sip;
    sip.x_units = static_cast<std::uint16_t>(x_units);
    sip.y_units = static_cast<std::uint16_t>(y_units);
    sip.heading_units = static_cast<std::int16_t>(heading_units);
    now += std::chrono::milliseconds{100};
    return tracker.observe(sip, now);
  }

  OdometryTracker tracker;
  Timestamp now = timestamp_from_ns(1'700'000'000'000'000'000);
};

TEST(OdometryTracker, TakesTheFirstSipAsReference) {
  Drive drive;
  const Odometry first = drive.at(12'345, 321, 1024);
  EXPECT_EQ(first.odom_from_robot.x, 0.0);
  EXPECT_EQ(first.odom_from_robot.y, 0.0);
  EXPECT_NEAR(first.odom_from_robot.theta, std::numbers::pi / 2, kTolerance);
  EXPECT_EQ(first.epoch, 0u);
  EXPECT_NEAR(drive.at(12'445, 321, 1024).odom_from_robot.x, 0.1, kTolerance);
}

TEST(OdometryTracker, DrivesThroughTheWrapOfFifteenAndOfSixteenBits) {
  for (const int modulus : {1 << 15, 1 << 16}) {
    Drive drive;
    for (int step = 0; step <= 2000; ++step) {
      const int x = 100 * step % modulus;
      const int y = ((modulus - 100 * step) % modulus + modulus) % modulus;
      const Odometry odometry = drive.at(x, y);
      ASSERT_NEAR(odometry.odom_from_robot.x, 0.1 * step, kTolerance);
      ASSERT_NEAR(odometry.odom_from_robot.y, -0.1 * step, kTolerance);
      ASSERT_EQ(odometry.epoch, 0u);
    }
  }
}

TEST(OdometryTracker, TurnsThroughTheWrapOfTheHeadingBothWays) {
  for (const int sense : {1, -1}) {
    Drive drive;
    for (int step = 0; step < 200; ++step) {
      const int turned = sense * 100 * step;
      const int signed_wrap = (turned + 2048) % 4096 - 2048;
      const Odometry odometry = drive.at(0, 0, signed_wrap);
      ASSERT_EQ(odometry.epoch, 0u);
      const double expected = turned * 2 * std::numbers::pi / 4096;
      ASSERT_NEAR(turn_between(odometry.odom_from_robot.theta, expected), 0.0, kTolerance);
    }
  }
}

TEST(OdometryTracker, ConvertsUnitsByModel) {
  Drive drive{*model_named("p3dx")};
  (void)drive.at(0);
  EXPECT_NEAR(drive.at(1000).odom_from_robot.x, 0.485, kTolerance);
  EXPECT_FALSE(model_named("at"));
}

TEST(OdometryTracker, BeginsAnEpochWhereThePoseJumps) {
  Drive drive;
  (void)drive.at(0);
  (void)drive.at(100);
  const Odometry reset = drive.at(5000, 0, 0);
  EXPECT_EQ(reset.epoch, 1u);
  EXPECT_EQ(reset.odom_from_robot.x, 0.0) << "the jump is not integrated";
  EXPECT_NEAR(drive.at(5100).odom_from_robot.x, 0.1, kTolerance);
}

TEST(OdometryTracker, BeginsAnEpochWhereTheHeadingJumps) {
  Drive drive;
  (void)drive.at(0, 0, 0);
  EXPECT_EQ(drive.at(0, 0, 330).epoch, 0u) << "29 degrees";
  EXPECT_EQ(drive.at(0, 0, 330 + 353).epoch, 1u) << "31 degrees";
}

TEST(OdometryTracker, AllowsALongStepAfterALostSipButNotAfterAnAmbiguousGap) {
  Drive drive;
  (void)drive.at(0);
  drive.now += std::chrono::milliseconds{900};
  EXPECT_EQ(drive.at(2200).epoch, 0u) << "2.2 m in a second";
  drive.now += std::chrono::seconds{10};
  EXPECT_EQ(drive.at(2200).epoch, 1u) << "it may have driven a whole wrap";
}

TEST(OdometryTracker, BeginsAnEpochWithAnotherModelOnlyAfterTheFirstSip) {
  OdometryTracker tracker{kSh};
  tracker.set_model(*model_named("p3dx"));
  tracker.begin_epoch();
  EXPECT_EQ(tracker.observe(Sip{}, Timestamp{}).epoch, 0u);
  tracker.set_model(kSh);
  EXPECT_EQ(tracker.observe(Sip{}, Timestamp{}).epoch, 1u);
}

TEST(OdometryTracker, TellsTheChargerByItsFlagAndByEachChargeState) {
  const auto charging = [](std::uint16_t flags, std::optional<std::uint8_t> state) {
    Sip sip;
    sip.flags = flags;
    sip.charge_state = state;
    return OdometryTracker{kSh}.observe(sip, Timestamp{}).charging;
  };
  EXPECT_FALSE(charging(0, std::nullopt)) << "a controller that tells neither";
  EXPECT_FALSE(charging(0xFBFF, 0)) << "every flag but bit 10";
  EXPECT_TRUE(charging(1u << 10, std::nullopt)) << "early firmware has the flag alone";
  EXPECT_TRUE(charging(1u << 10, 0)) << "plugged in, no current yet";
  for (const std::uint8_t state : std::vector<std::uint8_t>{1, 2, 3, 4})
    EXPECT_TRUE(charging(0, state)) << "state " << int{state};
  for (const std::uint8_t state : std::vector<std::uint8_t>{5, 128, 255})
    EXPECT_FALSE(charging(0, state)) << "no state: " << int{state};
}

TEST(OdometryTracker, TakesTheVoltageFromWhereTheControllerTellsOne) {
  const auto volts = [](std::uint8_t narrow, std::optional<std::uint16_t> wide) {
    Sip sip;
    sip.battery_decivolts = narrow;
    sip.battery_x10_decivolts = wide;
    return OdometryTracker{kSh}.observe(sip, Timestamp{}).battery_v;
  };
  EXPECT_NEAR(volts(121, std::nullopt), 12.1, kTolerance);
  EXPECT_NEAR(volts(255, 264), 26.4, kTolerance) << "a pack of 24 V does not fit the byte";
  EXPECT_NEAR(volts(121, 0), 12.1, kTolerance);
  EXPECT_NEAR(volts(0, 121), 12.1, kTolerance);
  EXPECT_EQ(volts(0, 0), 0.0);
  EXPECT_EQ(volts(0, std::nullopt), 0.0);
}

TEST(OdometryTracker, TakesTheTurnOfAnUnknownTrackFromTheController) {
  OdometryTracker tracker{{.turn_rate_per_speed = 0.0}};
  Sip sip;
  sip.left_mm_per_s = -100;
  sip.right_mm_per_s = 100;
  sip.turn_rate_decideg_per_s = 195;
  EXPECT_NEAR(tracker.observe(sip, Timestamp{}).turn_rate_rad_per_s, 19.5 * std::numbers::pi / 180.0, kTolerance);
  sip.turn_rate_decideg_per_s.reset();
  sip.heading_units = 22;
  EXPECT_NEAR(tracker.observe(sip, Timestamp{} + std::chrono::milliseconds{100}).turn_rate_rad_per_s,
              22 * 2 * std::numbers::pi / 4096 / 0.1, kTolerance);
}

TEST(OdometryTracker, KnowsSubtypesByTheirBeginning) {
  for (const char* subtype : {"p3dx-sh", "p3dx-sh-lms500", "p3dx-sh-lms1xx", "P3DX-SH"}) {
    ASSERT_TRUE(model_named(subtype)) << subtype;
    EXPECT_EQ(model_named(subtype)->metres_per_unit, 0.001) << subtype;
  }
  EXPECT_EQ(model_named("p3dx")->metres_per_unit, 0.000485);
  for (const char* subtype : {"", "p3at", "p3at-sh", "powerbot-sh", "p3d", "p3dx-s", "p3dxe", "sh-p3dx-sh"}) {
    EXPECT_FALSE(model_named(subtype)) << subtype;
  }
}

TEST(OdometryTracker, ReportsSpeedsAndState) {
  Sip sip;
  sip.left_mm_per_s = 100;
  sip.right_mm_per_s = 300;
  sip.right_stall = true;
  sip.flags = sip_flag::kMotorsEnabled | sip_flag::kStopButton;
  sip.front_bumpers = 4;
  sip.battery_decivolts = 121;
  OdometryTracker tracker{kSh};
  const Odometry odometry = tracker.observe(sip, Timestamp{});
  EXPECT_NEAR(odometry.speed_m_per_s, 0.2, kTolerance);
  EXPECT_NEAR(odometry.turn_rate_rad_per_s, 0.56, kTolerance);
  EXPECT_TRUE(odometry.stalled);
  EXPECT_TRUE(odometry.motors_enabled);
  EXPECT_TRUE(odometry.stop_button);
  EXPECT_EQ(odometry.front_bumpers, 4);
  EXPECT_NEAR(odometry.battery_v, 12.1, kTolerance);
}

}  // namespace
}  // namespace deltamap::drivers::pioneer
