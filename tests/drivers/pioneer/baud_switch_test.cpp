// SPDX-License-Identifier: Apache-2.0
#include "drivers/pioneer/baud_switch.hpp"

#include "tests/drivers/pioneer/part_fixture.hpp"

namespace deltamap::drivers::pioneer {
namespace {

class BaudSwitchTest : public PartTest {
 protected:
  void allow(std::uint8_t auto_baud) {
    ConfigPacket config;
    config.auto_baud = auto_baud;
    take(encoded_config(config));
  }
  void time_out() {
    Transmitter to = line();
    baud_switch.time_out(to);
  }
  /// To where PULSE was sent at the new speed.
  void begin() {
    Transmitter to = line();
    baud_switch.begin(to);
    EXPECT_EQ(sent(), (std::vector<Command>{{CommandNumber::kHostBaud, 2}}));
    for (int i = 0; i < 3; ++i) {
      now = std::max(now, baud_switch.deadline());
      time_out();
    }
    EXPECT_EQ(receiver.baud(), 38400u);
    EXPECT_EQ(sent(), (std::vector<Command>{{CommandNumber::kPulse, {}}}));
    EXPECT_FALSE(baud_switch.is_over());
  }

  BaudSwitch baud_switch{38400};
};

TEST_F(BaudSwitchTest, IsDueOnceInAConnectionWhereTheRobotAllowsIt) {
  EXPECT_FALSE(baud_switch.is_due(receiver));
  allow(0);
  EXPECT_FALSE(baud_switch.is_due(receiver));
  allow(1);
  EXPECT_TRUE(baud_switch.is_due(receiver));
  EXPECT_FALSE(BaudSwitch{0}.is_due(receiver));
  EXPECT_FALSE(BaudSwitch{9600}.is_due(receiver)) << "it is there";
  begin();
  receiver.set_baud(9600);
  EXPECT_FALSE(baud_switch.is_due(receiver));
  baud_switch.forget();
  EXPECT_TRUE(baud_switch.is_due(receiver));
}

TEST_F(BaudSwitchTest, IsOverWithAnyPacketAtTheNewSpeed) {
  begin();
  Transmitter to = line();
  baud_switch.hear_packet(to);
  EXPECT_TRUE(baud_switch.is_over());
  EXPECT_EQ(receiver.baud(), 38400u);
}

TEST_F(BaudSwitchTest, GoesBackWhereNothingComes) {
  begin();
  now = baud_switch.deadline();
  time_out();
  EXPECT_TRUE(baud_switch.is_over());
  EXPECT_EQ(receiver.baud(), 9600u);
}

}  // namespace
}  // namespace deltamap::drivers::pioneer
