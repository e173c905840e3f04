// SPDX-License-Identifier: Apache-2.0
// The frames of golden_vectors.json, in both directions.
#include <gtest/gtest.h>

#include "drivers/lms200/command.hpp"
#include "drivers/lms200/measurement.hpp"
#include "drivers/lms200/telegram.hpp"
#include "tests/support/bytes/golden_vectors.hpp"
#include "tests/support/bytes/hex.hpp"

namespace deltamap::drivers::lms200 {
namespace {

using tests::bytes_from_hex;
using tests::hex_of;

std::vector<Telegram> telegrams_in(Sender sender, const std::string& hex) {
  TelegramDecoder decoder{sender, 38400};
  auto telegrams = decoder.decode(bytes_from_hex(hex), Timestamp{});
  for (Telegram& telegram : decoder.finish()) telegrams.push_back(std::move(telegram));
  return telegrams;
}

TEST(LmsGolden, CrcsAgree) {
  DELTAMAP_GOLDEN_VECTORS_OR_SKIP(golden);
  for (const auto& vector : golden["crc16"]) {
    const std::string data = vector["data"];
    EXPECT_EQ(crc16(bytes_from_hex(data)), std::stoul(vector["crc_value"].get<std::string>(), nullptr, 16)) << data;
  }
}

TEST(LmsGolden, RequestsDecodeAndEncodeToTheirBytes) {
  DELTAMAP_GOLDEN_VECTORS_OR_SKIP(golden);
  for (const auto& vector : golden["lms_host"]) {
    const std::string hex = vector["hex"];
    const auto telegrams = telegrams_in(Sender::kHost, hex);
    ASSERT_EQ(telegrams.size(), 1u) << vector["name"];
    const Telegram& t = telegrams[0];
    EXPECT_EQ(hex_of(t.data), vector["fields"]["data"]) << vector["name"];
    EXPECT_EQ(t.address, vector["fields"]["address"]) << vector["name"];
    EXPECT_EQ(hex_of(encoded_request(t.command, t.data, t.address)), hex) << vector["name"];
  }
}

TEST(LmsGolden, NamedRequestsHaveTheirBytes) {
  DELTAMAP_GOLDEN_VECTORS_OR_SKIP(golden);
  Configuration documented;
  documented.set_units(Units::kMillimetre);
  Configuration far = documented;
  far.set_measuring_mode(0x06);
  const std::map<std::string, std::vector<std::uint8_t>> ours{
      {"install mode, password SICK_LMS", installation_request()},
      {"output on request (25h)", mode_request(mode::kOnRequest)},
      {"baud 38400", baud_request(38400)},
      {"baud 9600", baud_request(9600)},
      {"status request", status_request()},
      {"variant 180/0.5", variant_request({180, 50})},
      {"variant 100/0.25", variant_request({100, 25})},
      {"read configuration part 1", configuration_request()},
      {"request one scan", scan_request()},
      {"request errors", errors_request()},
      {"9600 at power-on", permanent_baud_request(false)},
      {"configure 77h with the documented defaults", write_configuration_request(documented)},
      {"configure 77h as MRPT writes it (mm, measuring mode 06h = 32 m)", write_configuration_request(far)},
  };
  std::size_t compared = 0;
  for (const auto& vector : golden["lms_host"]) {
    const auto found = ours.find(vector["name"]);
    if (found == ours.end()) continue;
    ++compared;
    EXPECT_EQ(hex_of(found->second), vector["hex"]) << vector["name"];
  }
  EXPECT_EQ(compared, ours.size());
}

TEST(LmsGolden, RepliesDecodeAndEncodeToTheirBytes) {
  DELTAMAP_GOLDEN_VECTORS_OR_SKIP(golden);
  for (const auto& vector : golden["lms_device"]) {
    const std::string hex = vector["hex"];
    const auto telegrams = telegrams_in(Sender::kDevice, hex);
    ASSERT_EQ(telegrams.size(), 1u) << vector["name"];
    const Telegram& t = telegrams[0];
    if (t.kind == Telegram::Kind::kAck) continue;
    EXPECT_EQ(t.status, 0x10) << vector["name"];
    EXPECT_EQ(hex_of(encoded_reply(t.command, t.data, t.status, t.address)), hex) << vector["name"];
  }
}

TEST(LmsGolden, RepliesMeanWhatTheySay) {
  DELTAMAP_GOLDEN_VECTORS_OR_SKIP(golden);
  const auto& replies = golden["lms_device"];
  const auto telegram = [&](std::size_t i) { return telegrams_in(Sender::kDevice, replies[i]["hex"]).at(0); };
  EXPECT_EQ(mode_was_switched(telegram(0)), true);
  EXPECT_EQ(telegram(1).command, response::kRefused);
  EXPECT_EQ(hex_of(type_reply("LMS200;301063;V02.10 ")), replies[2]["hex"]);
  const auto written = decoded_write_reply(telegram(3));
  ASSERT_TRUE(written);
  EXPECT_TRUE(written->accepted);
  EXPECT_EQ(written->active.units(), Units::kMillimetre);
  const auto variant = decoded_variant_reply(telegram(4));
  ASSERT_TRUE(variant);
  EXPECT_FALSE(variant->accepted);
  EXPECT_EQ(name_of(variant->active), "180/0.5");
}

TEST(LmsGolden, ScansDecodeToTheirRangesAndEncodeToTheirBytes) {
  DELTAMAP_GOLDEN_VECTORS_OR_SKIP(golden);
  for (const auto& vector : golden["lms_scan_decode"]) {
    const std::string hex = vector["hex"];
    const auto telegrams = telegrams_in(Sender::kDevice, hex);
    ASSERT_EQ(telegrams.size(), 1u) << vector["name"];
    const auto measurement = decoded_measurement(telegrams[0]);
    ASSERT_TRUE(measurement) << vector["name"];
    EXPECT_EQ(hex_of(encoded_measurement(*measurement)), hex) << vector["name"];
    const auto& fields = vector["fields"];
    EXPECT_EQ(measurement->words.size(), fields["n"]) << vector["name"];
    EXPECT_EQ(measurement->is_partial, fields.value("partial", false)) << vector["name"];
    if (measurement->is_partial) {
      EXPECT_EQ(0.25 * measurement->partial_number, fields["partial_offset_deg"]);
    }
    if (fields.contains("scan_index")) {
      ASSERT_TRUE(measurement->indices);
      EXPECT_EQ(measurement->indices->scan, fields["scan_index"]);
      EXPECT_EQ(measurement->indices->telegram, fields["telegram_index"]);
    }
    if (!fields.contains("ranges")) continue;
    const auto mode = static_cast<std::uint8_t>(std::stoul(fields["measuring_mode"].get<std::string>(), nullptr, 16));
    const RangeCoding coding = *range_coding(mode);
    for (std::size_t i = 0; i < measurement->words.size(); ++i) {
      const Beam beam = decoded_beam(measurement->words[i], coding, measurement->metres_per_word(), 100.0);
      const auto& expected = fields["ranges"][i];
      EXPECT_EQ(beam.kind == BeamKind::kRange, expected.is_number()) << vector["name"] << " value " << i;
      if (expected.is_number()) {
        EXPECT_FLOAT_EQ(beam.range_m, expected.get<float>() / 1000.0F);
      }
    }
  }
}

TEST(LmsGolden, NegativeFramesDecodeToNothing) {
  DELTAMAP_GOLDEN_VECTORS_OR_SKIP(golden);
  for (const auto& vector : golden["lms_negative"]) {
    if (!vector.contains("hex")) continue;
    const std::string hex = vector["hex"];
    const bool is_from_device = hex.starts_with("0280");
    const auto telegrams = telegrams_in(is_from_device ? Sender::kDevice : Sender::kHost, hex);
    if (vector["name"] == "STX inside data") {
      ASSERT_EQ(telegrams.size(), 1u);
      EXPECT_EQ(decoded_measurement(telegrams[0])->words, (std::vector<std::uint16_t>{0x8002, 0x0280, 0x0280}));
    } else if (vector["name"] == "wrong address 05h") {
      ASSERT_EQ(telegrams.size(), 1u) << "the frame is right; it is not for us";
      EXPECT_EQ(telegrams[0].address, 5);
    } else {
      EXPECT_TRUE(telegrams.empty()) << vector["name"];
    }
  }
}

}  // namespace
}  // namespace deltamap::drivers::lms200
