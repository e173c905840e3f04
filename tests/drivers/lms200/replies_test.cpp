// SPDX-License-Identifier: Apache-2.0
// Status, configuration and the small answers of the laser, there and back.
#include <gtest/gtest.h>

#include "drivers/lms200/command.hpp"
#include "drivers/lms200/status.hpp"
#include "tests/support/bytes/hex.hpp"

namespace deltamap::drivers::lms200 {
namespace {

Telegram from_device(const std::vector<std::uint8_t>& frame) {
  TelegramDecoder decoder{Sender::kDevice, 38400};
  return decoder.decode(frame, Timestamp{}).at(0);
}

Telegram from_host(const std::vector<std::uint8_t>& frame) {
  TelegramDecoder decoder{Sender::kHost, 38400};
  return decoder.decode(frame, Timestamp{}).at(0);
}

TEST(DeviceStatus, ComesBackWholeIn160Bytes) {
  DeviceStatus status;
  status.software_version = "V02.19 ";
  status.pollution = {1, 2, 3, 4, 5, 6, 7, 0x0808};
  status.reference_pollution = {9, 10, 11, 12};
  status.measuring_mode = 6;
  status.scan_angle_deg = 100;
  status.resolution_centideg = 25;
  status.baud_code = *baud_code(500000);
  status.units = 1;
  status.boot_version = "V01.42 ";
  const auto frame = status_reply(status);
  EXPECT_EQ(frame.size(), 0x9Au + kFrameOverhead);
  EXPECT_EQ(decoded_status(from_device(frame)), status);
}

TEST(DeviceStatus, HasItsFieldsAtTheOffsetsOfTheListing) {
  DeviceStatus status;
  status.measuring_mode = 5;
  status.units = 1;
  const auto frame = status_reply(status);
  constexpr std::size_t kResponse = 4;  // offsets count from the response byte
  EXPECT_EQ(frame[kResponse], 0xB1);
  EXPECT_EQ(frame[kResponse + 102], 5);
  EXPECT_EQ(frame[kResponse + 107], 180);
  EXPECT_EQ(frame[kResponse + 109], 100);
  EXPECT_EQ(frame[kResponse + 116], 0x67);
  EXPECT_EQ(frame[kResponse + 117], 0x80);
  EXPECT_EQ(frame[kResponse + 122], 1);
  EXPECT_EQ(frame[kResponse + 153], kNormalStatus);
}

TEST(DeviceStatus, KnowsTheFourSpeeds) {
  for (const unsigned baud : {9600u, 19200u, 38400u, 500000u}) {
    DeviceStatus status;
    status.baud_code = *baud_code(baud);
    EXPECT_EQ(status.baud(), baud);
    EXPECT_EQ(baud_of_mode(*mode_of_baud(baud)), baud);
  }
  EXPECT_FALSE(baud_code(115200));
  EXPECT_FALSE(mode_of_baud(115200));
}

TEST(DeviceStatus, IsRefusedWhenShort) {
  EXPECT_FALSE(decoded_status(from_device(encoded_reply(response::kStatus, std::vector<std::uint8_t>(151, 0)))));
  EXPECT_FALSE(decoded_status(from_device(mode_reply(true))));
}

TEST(Configuration, ComesBackFromReadAndWrite) {
  Configuration configuration;
  configuration.set_measuring_mode(6);
  configuration.set_units(Units::kMillimetre);
  configuration.bytes[33] = 9;
  EXPECT_EQ(decoded_configuration(from_device(configuration_reply(configuration))), configuration);
  const auto refused = decoded_write_reply(from_device(configuration_written_reply(false, configuration)));
  ASSERT_TRUE(refused);
  EXPECT_FALSE(refused->accepted);
  EXPECT_EQ(refused->active, configuration);
  EXPECT_EQ(configuration_with(from_host(write_configuration_request(configuration)).data, {}), configuration);
}

TEST(Configuration, MayBeWrittenInPart) {
  Configuration before;
  before.bytes[20] = 77;
  const auto after = configuration_with(tests::bytes_from_hex("00004600000601"), before);
  ASSERT_TRUE(after);
  EXPECT_EQ(after->measuring_mode(), 6);
  EXPECT_EQ(after->bytes[20], 77);
  EXPECT_FALSE(configuration_with({}, before));
  EXPECT_FALSE(configuration_with(std::vector<std::uint8_t>(35, 0), before));
}

TEST(Configuration, IsRefusedWhenShort) {
  const std::vector<std::uint8_t> short_data(33, 0);
  EXPECT_FALSE(decoded_configuration(from_device(encoded_reply(response::kConfiguration, short_data))));
  EXPECT_FALSE(decoded_write_reply(from_device(encoded_reply(response::kConfigurationWritten, short_data))));
}

TEST(VariantReply, ComesBack) {
  const auto reply = decoded_variant_reply(from_device(variant_reply(true, {100, 25})));
  ASSERT_TRUE(reply);
  EXPECT_TRUE(reply->accepted);
  EXPECT_EQ(name_of(reply->active), "100/0.25");
  EXPECT_EQ(requested_variant(from_host(variant_request({180, 50}))), (ScanVariant{180, 50}));
  EXPECT_FALSE(requested_variant(from_host(status_request())));
}

TEST(ModeReply, ComesBack) {
  EXPECT_EQ(mode_was_switched(from_device(mode_reply(true))), true);
  EXPECT_EQ(mode_was_switched(from_device(mode_reply(false))), false);
  EXPECT_FALSE(mode_was_switched(from_device(refused_reply())));
}

TEST(Password, IsComparedWhole) {
  EXPECT_TRUE(has_right_password(from_host(installation_request())));
  EXPECT_FALSE(has_right_password(from_host(installation_request("SICK_LM"))));
  EXPECT_FALSE(has_right_password(from_host(installation_request("SICK_LMT"))));
}

TEST(ScanVariant, HasSixFormsOfWhichTwoHaveAsManyValues) {
  for (const char* name : {"180/1", "180/0.5", "100/1", "100/0.5", "100/0.25"}) {
    const auto variant = variant_named(name);
    ASSERT_TRUE(variant) << name;
    EXPECT_EQ(name_of(*variant), name);
    EXPECT_EQ(variant_with_values(variant->values()), variant);
  }
  const ScanVariant fast = variant_named("90/0.5").value();
  EXPECT_EQ(name_of(fast), "90/0.5");
  EXPECT_EQ(variant_with_values(fast.values()), (ScanVariant{180, 100})) << "unless the laser tells otherwise";
  EXPECT_FALSE(variant_named("180/0.25"));
  EXPECT_FALSE(is_possible({180, 25}));
  EXPECT_FALSE(variant_with_values(180));
}

}  // namespace
}  // namespace deltamap::drivers::lms200
