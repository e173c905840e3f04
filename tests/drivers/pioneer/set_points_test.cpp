// SPDX-License-Identifier: Apache-2.0
#include "drivers/pioneer/set_points.hpp"

#include "tests/drivers/pioneer/part_fixture.hpp"

namespace deltamap::drivers::pioneer {
namespace {

class SetPointsTest : public PartTest {
 protected:
  void SetUp() override {
    Transmitter to = line();
    set_points.begin_connection(to);
    EXPECT_EQ(sent(), kStand) << "before anything else";
  }
  void drive(double speed_m_per_s, double turn_rate_rad_per_s) {
    Transmitter to = line();
    set_points.drive({now, speed_m_per_s, turn_rate_rad_per_s}, to);
  }
  void emergency_stop() {
    Transmitter to = line();
    set_points.emergency_stop(to);
  }
  void pulse() {
    now = std::max(now, set_points.next_pulse());
    Transmitter to = line();
    set_points.pulse(to);
  }
  void show_speed(std::int16_t mm_per_s) {
    Sip sip;
    sip.left_mm_per_s = mm_per_s;
    take(encoded_sip(sip));
  }

  static inline const std::vector<Command> kStand{{CommandNumber::kVel, 0}, {CommandNumber::kRvel, 0}};
  static inline const std::vector<Command> kForward{{CommandNumber::kVel, 300}, {CommandNumber::kRvel, 0}};
  static inline const std::vector<Command> kPulse{{CommandNumber::kPulse, {}}};
  static inline const std::vector<Command> kEstop{{CommandNumber::kEstop, {}}};

  SetPoints set_points{MotionLimits{}, 0.5};
};

TEST_F(SetPointsTest, RepeatsASetPointInPlaceOfThePulse) {
  pulse();
  EXPECT_EQ(sent(), kPulse);
  drive(0.3, 0.0);
  EXPECT_EQ(sent(), kForward);
  drive(0.3, 0.0);
  EXPECT_TRUE(commands.is_empty()) << "nothing new";
  pulse();
  EXPECT_EQ(sent(), kForward);
  Transmitter to = line();
  set_points.stop(to);
  EXPECT_EQ(sent(), kStand);
  pulse();
  EXPECT_EQ(sent(), kPulse);
}

TEST_F(SetPointsTest, HoldsAnEmergencyStopUntilASetPointThatMoves) {
  drive(0.3, 0.0);
  emergency_stop();
  EXPECT_EQ(sent(), kEstop) << "the set point that waited is gone";
  emergency_stop();
  EXPECT_TRUE(commands.is_empty());
  show_speed(300);
  now += std::chrono::milliseconds{100};
  drive(0.0, 0.0);
  EXPECT_EQ(sent(), kEstop) << "again, and no VEL 0 that would withdraw it";
  show_speed(0);
  pulse();
  EXPECT_EQ(sent(), kEstop) << "in place of the pulse";
  drive(0.3, 0.0);
  EXPECT_EQ(sent(), kForward);
}

TEST_F(SetPointsTest, StandsAndStaysSoWhereMotionIsRefused) {
  drive(0.3, 0.0);
  (void)sent();
  Transmitter to = line();
  set_points.refuse_motion(to);
  EXPECT_EQ(sent(), kStand);
  set_points.refuse_motion(to);
  EXPECT_TRUE(commands.is_empty());
}

TEST_F(SetPointsTest, PulsesFourTimesWithinAShortWatchdog) {
  ConfigPacket config;
  config.watchdog_ms = 400;
  take(encoded_config(config));
  Transmitter to = line();
  set_points.heed_watchdog(to);
  EXPECT_EQ(set_points.next_pulse(), commands.last_sent().value() + std::chrono::milliseconds{100});
}

}  // namespace
}  // namespace deltamap::drivers::pioneer
