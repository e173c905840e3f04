// SPDX-License-Identifier: Apache-2.0
// What the robot sends besides echoes: SIP, CONFIGpac, ENCODERpac, GYROpac, IOpac.
#include <gtest/gtest.h>

#include "core/random.hpp"
#include "drivers/pioneer/config_packet.hpp"
#include "drivers/pioneer/extra_packets.hpp"
#include "drivers/pioneer/packet.hpp"
#include "drivers/pioneer/status.hpp"
#include "tests/support/bytes/damage.hpp"
#include "tests/support/bytes/hex.hpp"

namespace deltamap::drivers::pioneer {
namespace {

using tests::bytes_from_hex;

std::vector<std::uint8_t> data_of(const std::vector<std::uint8_t>& frame) {
  return {frame.begin() + 3, frame.end() - 2};
}

Sip full_sip() {
  Sip sip;
  sip.moving = true;
  sip.x_units = 0x7FFF;
  sip.y_units = 0x8001;
  sip.heading_units = -1024;
  sip.left_mm_per_s = -300;
  sip.right_mm_per_s = 310;
  sip.battery_decivolts = 128;
  sip.left_stall = true;
  sip.rear_bumpers = 0x41;
  sip.front_bumpers = 0x7F;
  sip.control_units = 77;
  sip.flags = sip_flag::kMotorsEnabled | sip_flag::kStopButton;
  sip.compass = 9;
  sip.sonar = {{0, 5000}, {31, 170}};
  sip.grip_state = std::uint8_t{1};
  sip.analog_port = std::uint8_t{2};
  sip.analog = std::uint8_t{3};
  sip.digital_in = std::uint8_t{4};
  sip.digital_out = std::uint8_t{5};
  sip.battery_x10_decivolts = std::uint16_t{129};
  sip.charge_state = std::uint8_t{3};
  sip.turn_rate_decideg_per_s = std::int16_t{-123};
  sip.fault_flags = std::uint16_t{0x8001};
  sip.lateral_mm_per_s = std::int16_t{-1};
  sip.temperature_c = std::int8_t{-127};
  sip.charge_percent = std::uint8_t{80};
  sip.controller_time_us = 0xFEDCBA98u;
  sip.flags3 = 0x80000001u;
  return sip;
}

TEST(Sip, ComesBackWholeWithItsWholeTail) {
  const Sip sip = full_sip();
  EXPECT_EQ(decoded_sip(sip_data(sip)), sip);
}

TEST(Sip, PutsEveryFieldWhereTheManualHasIt) {
  Sip sip;
  sip.x_units = 0x0102;
  sip.rear_bumpers = 0x01;
  sip.right_stall = true;
  sip.battery_decivolts = 128;
  EXPECT_EQ(tests::hex_of(sip_data(sip)),
            "32"
            "0201"
            "0000"
            "0000"
            "0000"
            "0000"
            "80"
            "02"
            "01"
            "0000"
            "0000"
            "00"
            "00");
}

TEST(Sip, KeepsItsPoseWhereverTheOptionalPartIsCut) {
  const Sip sip = full_sip();
  const auto data = sip_data(sip);
  constexpr std::size_t kFixedPart = 18;
  for (std::size_t size = 0; size < data.size(); ++size) {
    const auto cut = decoded_sip(std::span{data}.first(size));
    ASSERT_EQ(cut.has_value(), size >= kFixedPart) << size;
    if (!cut) continue;
    EXPECT_EQ(cut->x_units, sip.x_units);
    EXPECT_EQ(cut->flags, sip.flags);
    EXPECT_FALSE(cut->flags3);
  }
}

TEST(Sip, DoesNotReadSonarThatDidNotCome) {
  auto data = sip_data(Sip{});
  for (const std::uint8_t promised : {std::uint8_t{1}, std::uint8_t{16}, std::uint8_t{33}, std::uint8_t{255}}) {
    data[19] = promised;
    const auto sip = decoded_sip(data);
    ASSERT_TRUE(sip);
    EXPECT_TRUE(sip->sonar_is_cut);
    EXPECT_TRUE(sip->sonar.empty());
    EXPECT_FALSE(sip->grip_state);
  }
}

TEST(Sip, SurvivesRandomContent) {
  Random random{3};
  for (int i = 0; i < 20'000; ++i) {
    auto data = tests::random_bytes(1 + random.index_below(120), random);
    data[0] = kSipMoving;
    const auto sip = decoded_sip(data);
    if (!sip) continue;
    EXPECT_LE(sip->sonar.size(), 32u);
  }
}

TEST(ConfigPacket, ComesBackWhole) {
  ConfigPacket config;
  config.subtype = "p3dx";
  config.name = "MAPPER_1";
  config.serial_number = "QXR4711";
  config.watchdog_ms = 1500;
  config.auto_baud = 2;
  config.drift_factor = -12;
  config.firmware_version = "2.9";
  config.kinematics_delay_ms = 30;
  config.soc_shutdown = 11;
  const auto frame = encoded_config(config);
  EXPECT_EQ(decoded_config(data_of(frame)), config);
}

TEST(ConfigPacket, StopsWhereThePacketStops) {
  ConfigPacket config;
  config.watchdog_ms = 1500;
  config.auto_baud = 2;
  const auto data = data_of(encoded_config(config));
  const std::size_t names = 1 + config.type.size() + 1 + config.subtype.size() + 1;
  for (std::size_t size = 0; size < data.size(); ++size) {
    const auto cut = decoded_config(std::span{data}.first(size));
    ASSERT_EQ(cut.has_value(), size >= names) << size;
    if (cut) {
      EXPECT_EQ(cut->subtype, "p3dx-sh");
    }
  }
  // Type 20, three strings of 8 + 8 + 1 bytes, four-motors byte, five words, name, three bytes, word, word, byte, word,
  // word: then the watchdog.
  constexpr std::size_t kBeforeWatchdog = 1 + 8 + 8 + 1 + 1 + 10 + 1 + 3 + 2 + 2 + 1 + 2 + 2;
  EXPECT_FALSE(decoded_config(std::span{data}.first(kBeforeWatchdog + 1))->watchdog_ms) << "no default confirms it";
  EXPECT_EQ(decoded_config(std::span{data}.first(kBeforeWatchdog + 2))->watchdog_ms, 1500);
}

TEST(EncoderPacket, ComesBackWholeAndIsRefusedWhenCut) {
  const EncoderCounts counts{-1, 2'000'000'000};
  const auto data = data_of(encoded_encoder(counts));
  EXPECT_EQ(decoded_encoder(data), counts);
  EXPECT_FALSE(decoded_encoder(std::span{data}.first(data.size() - 1)));
}

TEST(GyroPacket, ComesBackWholeAndIsRefusedWhenCut) {
  const std::vector<GyroReading> readings{{512, 20}, {500, 21}, {1023, 22}, {0, 23}};
  const auto data = data_of(encoded_gyro(readings));
  EXPECT_EQ(decoded_gyro(data), readings);
  EXPECT_FALSE(decoded_gyro(std::span{data}.first(data.size() - 1)));
  EXPECT_GT(gyro_rate_rad_per_s(500, 512.0, 1.626), 0.0) << "less than the centre is counter-clockwise";
}

TEST(IoPacket, ComesBackWholeAndIsRefusedWhenCut) {
  const IoReadings readings{{1, 2}, {3}, {1023, 0}};
  const auto data = data_of(encoded_io(readings));
  EXPECT_EQ(decoded_io(data), readings);
  EXPECT_FALSE(decoded_io(std::span{data}.first(data.size() - 1)));
}

TEST(IdentityReply, IsRefusedWithoutItsThreeStrings) {
  EXPECT_FALSE(decoded_identity(bytes_from_hex("02")));
  EXPECT_FALSE(decoded_identity(bytes_from_hex("02 4100 4200 43")));
  EXPECT_EQ(decoded_identity(bytes_from_hex("02 4100 4200 4300")), (RobotIdentity{"A", "B", "C"}));
}

}  // namespace
}  // namespace deltamap::drivers::pioneer
