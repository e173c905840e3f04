// SPDX-License-Identifier: Apache-2.0
#include "drivers/pioneer/receiver.hpp"

#include "tests/drivers/pioneer/part_fixture.hpp"

namespace deltamap::drivers::pioneer {
namespace {

using ReceiverTest = PartTest;

TEST_F(ReceiverTest, ForgetsTheConfigurationAndBeginsAnEpochWhereTheRobotNamesItselfAnew) {
  const auto epoch = [&] {
    const auto packets = receiver.decode(encoded_sip(Sip{}), now += std::chrono::milliseconds{100});
    return receiver.take(packets.at(0)).odometry.value().epoch;
  };
  take(encoded_identity({"mapper", "Pioneer", "p3dx-sh"}));
  take(encoded_config(ConfigPacket{}));
  EXPECT_TRUE(receiver.knows_watchdog());
  const std::uint32_t before = epoch();
  take(encoded_identity({"mapper", "Pioneer", "p3dx-sh"}));
  EXPECT_FALSE(receiver.config());
  EXPECT_EQ(receiver.identity()->subtype, "p3dx-sh");
  EXPECT_EQ(epoch(), before + 1);
}

TEST_F(ReceiverTest, TakesTheWatchdogAsDeliveredUntilItIsTold) {
  EXPECT_EQ(receiver.watchdog(), std::chrono::milliseconds{2000});
  ConfigPacket config;
  config.watchdog_ms = 700;
  take(encoded_config(config));
  EXPECT_EQ(receiver.watchdog(), std::chrono::milliseconds{700});
}

TEST_F(ReceiverTest, SaysWhyARobotOfUnknownUnitsIsNotDriven) {
  const auto packets = receiver.decode(encoded_identity({"x", "Pioneer", "p3at"}), now);
  const Receiver::Content content = receiver.take(packets.at(0));
  EXPECT_EQ(content.log, "robot name=x type=Pioneer subtype=p3at");
  EXPECT_TRUE(content.units.is_warning);
  EXPECT_NE(receiver.why_never_driven(), "");
}

TEST_F(ReceiverTest, CountsWhatItCannotRead) {
  take(encoded_packet(std::vector<std::uint8_t>{kSipStopped, 1, 2}));
  take(encoded_packet(std::vector<std::uint8_t>{0x77, 1}));
  EXPECT_EQ(receiver.counts().malformed, 1u);
  EXPECT_EQ(receiver.counts().unknown, 1u);
  EXPECT_EQ(receiver.counts().frames, 2u);
}

}  // namespace
}  // namespace deltamap::drivers::pioneer
