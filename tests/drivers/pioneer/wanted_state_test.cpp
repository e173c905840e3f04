// SPDX-License-Identifier: Apache-2.0
#include "drivers/pioneer/wanted_state.hpp"

#include "tests/drivers/pioneer/part_fixture.hpp"

namespace deltamap::drivers::pioneer {
namespace {

class WantedStateTest : public PartTest {
 protected:
  void SetUp() override {
    Transmitter to = line();
    wanted.begin_connection(to);
  }
  /// A check; answers what went out.
  std::vector<CommandNumber> bring() {
    now = std::max(now, wanted.next_check());
    Transmitter to = line();
    wanted.bring(to);
    std::vector<CommandNumber> numbers;
    for (const Command& command : sent()) {
      wanted.note_sent(command, now);
      numbers.push_back(command.number);
    }
    return numbers;
  }
  void show(std::uint16_t flags) {
    Sip sip;
    sip.flags = flags;
    const Packet packet = take(encoded_sip(sip));
    Transmitter to = line();
    wanted.watch_motors(packet.first_byte, MotorReport::From::kConnection, to);
  }
  /// The controller shows all that it was asked for.
  void show_limits() {
    const MotionLimits limits;
    ConfigPacket config;
    config.watchdog_ms = 2000;
    config.trans_vel_max = static_cast<std::uint16_t>(whole_mm(limits.max_speed_m_per_s));
    config.rot_vel_max = static_cast<std::uint16_t>(whole_degrees(limits.max_turn_rate_rad_per_s));
    config.trans_acc = static_cast<std::uint16_t>(whole_mm(limits.acceleration_m_per_s2));
    config.trans_decel = static_cast<std::uint16_t>(whole_mm(limits.deceleration_m_per_s2));
    config.rot_acc = static_cast<std::uint16_t>(whole_degrees(limits.turn_acceleration_rad_per_s2));
    config.rot_decel = static_cast<std::uint16_t>(whole_degrees(limits.turn_deceleration_rad_per_s2));
    take(encoded_config(config));
  }

  using Numbers = std::vector<CommandNumber>;
  WantedState wanted{{.enable_motors = true, .drive_switch = DriveSwitch::kOn}};
};

TEST_F(WantedStateTest, AsksForTheLimitsUntilTheyShowAndThenEnablesOnce) {
  show(0);
  EXPECT_EQ(bring().back(), CommandNumber::kConfig);
  EXPECT_EQ(bring().back(), CommandNumber::kConfig);
  EXPECT_FALSE(wanted.may_be_driven(receiver));
  show_limits();
  EXPECT_TRUE(wanted.may_be_driven(receiver));
  EXPECT_EQ(bring(), Numbers{CommandNumber::kEnable});
  show(sip_flag::kMotorsEnabled);
  EXPECT_EQ(bring(), Numbers{});
}

TEST_F(WantedStateTest, TakesTheRobotAsItIsAfterFiveRequests) {
  show(sip_flag::kSonarArrays);
  int sonar = 0;
  for (int i = 0; i < 10; ++i) {
    const Numbers numbers = bring();
    sonar += static_cast<int>(std::count(numbers.begin(), numbers.end(), CommandNumber::kSonar));
  }
  EXPECT_EQ(sonar, 5);
  EXPECT_EQ(wanted.why_never_driven(receiver), "the robot does not tell its watchdog");
}

TEST_F(WantedStateTest, ForgetsAnEnableThatWaitsOnceTheStopButtonIsPressed) {
  show_limits();
  show(0);
  Transmitter to = line();
  wanted.bring(to);
  EXPECT_FALSE(commands.is_empty());
  show(sip_flag::kStopButton);
  EXPECT_TRUE(commands.is_empty());
  EXPECT_EQ(wanted.permission().drive_switch(), DriveSwitch::kOffAtRobot);
}

TEST_F(WantedStateTest, SwitchesOffAtTheOperatorsWordAndOnAgainAtTheNextCheck) {
  show_limits();
  show(0);
  Transmitter to = line();
  wanted.operator_switches(false, to);
  EXPECT_EQ(bring(), Numbers{});
  Transmitter later = line();
  wanted.operator_switches(true, later);
  EXPECT_EQ(wanted.next_check(), now);
  EXPECT_EQ(bring(), Numbers{CommandNumber::kEnable});
}

}  // namespace
}  // namespace deltamap::drivers::pioneer
