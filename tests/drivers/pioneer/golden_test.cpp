// SPDX-License-Identifier: Apache-2.0
// The frames of golden_vectors.json, in both directions.
#include <gtest/gtest.h>

#include <numbers>

#include "drivers/pioneer/command.hpp"
#include "drivers/pioneer/extra_packets.hpp"
#include "drivers/pioneer/packet.hpp"
#include "drivers/pioneer/status.hpp"
#include "tests/support/bytes/golden_vectors.hpp"
#include "tests/support/bytes/hex.hpp"

namespace deltamap::drivers::pioneer {
namespace {

using tests::bytes_from_hex;
using tests::hex_of;

std::vector<Packet> packets_in(const std::string& hex) {
  PacketDecoder decoder{9600};
  auto packets = decoder.decode(bytes_from_hex(hex), Timestamp{});
  for (Packet& packet : decoder.finish()) packets.push_back(std::move(packet));
  return packets;
}

TEST(PioneerGolden, CommandsDecodeToTheirFieldsAndEncodeToTheirBytes) {
  DELTAMAP_GOLDEN_VECTORS_OR_SKIP(golden);
  for (const auto& vector : golden["arcos_commands"]) {
    const std::string hex = vector["hex"];
    const auto packets = packets_in(hex);
    ASSERT_EQ(packets.size(), 1u) << vector["name"];
    const auto command = decoded_command(packets[0].data);
    ASSERT_TRUE(command) << vector["name"];
    EXPECT_EQ(hex_of(encoded_command(*command)), hex) << vector["name"];
    const auto& fields = vector["fields"];
    EXPECT_EQ(static_cast<int>(command->number), fields["command"]) << vector["name"];
    if (fields.contains("arg") && fields["arg"].is_number()) {
      EXPECT_EQ(command->integer_or(-1), fields["arg"]) << vector["name"];
    }
    if (fields.contains("left")) {
      const BytePair pair = byte_pair(command->integer_or(0));
      EXPECT_EQ(pair.left, fields["left"]) << vector["name"];
      EXPECT_EQ(pair.right, fields["right"]) << vector["name"];
      EXPECT_EQ(hex_of(encoded_command(byte_pair_command(CommandNumber::kVel2, pair))), hex) << vector["name"];
    }
  }
}

TEST(PioneerGolden, SipsDecodeToTheirFieldsAndEncodeToTheirBytes) {
  DELTAMAP_GOLDEN_VECTORS_OR_SKIP(golden);
  for (const auto& vector : golden["arcos_sips"]) {
    const std::string hex = vector["hex"];
    const auto packets = packets_in(hex);
    ASSERT_EQ(packets.size(), 1u) << vector["name"];
    const auto sip = decoded_sip(packets[0].data);
    ASSERT_TRUE(sip) << vector["name"];
    EXPECT_EQ(hex_of(encoded_sip(*sip)), hex) << vector["name"];
    const auto& fields = vector["fields"];
    const auto expect = [&](const char* key, const auto& value) {
      if (fields.contains(key)) {
        EXPECT_EQ(fields[key], value) << vector["name"] << " " << key;
      }
    };
    expect("x_raw", sip->x_units);
    expect("y_raw", sip->y_units);
    expect("th_raw", sip->heading_units);
    expect("th_deg", sip->heading_units * 360.0 / 4096.0);
    expect("lvel_mm_s", sip->left_mm_per_s);
    expect("rvel_mm_s", sip->right_mm_per_s);
    expect("battery_V", sip->battery_decivolts / 10.0);
    expect("stall_left", sip->left_stall);
    expect("stall_right", sip->right_stall);
    expect("motors_enabled", sip->has(sip_flag::kMotorsEnabled));
    expect("stop_button", sip->has(sip_flag::kStopButton));
  }
}

TEST(PioneerGolden, CapturedRepliesDecode) {
  DELTAMAP_GOLDEN_VECTORS_OR_SKIP(golden);
  for (const auto& vector : golden["arcos_replies_captured"]) {
    const std::string hex = vector["hex"];
    const auto packets = packets_in(hex);
    ASSERT_EQ(packets.size(), 1u) << vector["name"];
    EXPECT_EQ(hex_of(encoded_packet(packets[0].data)), hex) << vector["name"];
    const auto& fields = vector.value("fields", nlohmann::json::object());
    if (const auto identity = decoded_identity(packets[0].data)) {
      EXPECT_EQ(identity->name, fields["name"]);
      EXPECT_EQ(identity->type, fields["type"]);
      EXPECT_EQ(identity->subtype, fields["subtype"]);
      EXPECT_EQ(hex_of(encoded_identity(*identity)), hex);
    }
    if (is_sip(packets[0].type())) {
      const auto sip = decoded_sip(packets[0].data);
      ASSERT_TRUE(sip) << vector["name"];
      EXPECT_EQ(sip->flags, fields["flags"]);
      EXPECT_TRUE(sip->sonar_is_cut);
      EXPECT_TRUE(sip->sonar.empty());
    }
  }
}

TEST(PioneerGolden, NegativeFramesDecodeToNothing) {
  DELTAMAP_GOLDEN_VECTORS_OR_SKIP(golden);
  for (const auto& vector : golden["arcos_negative"]) {
    const std::string hex = vector["hex"];
    const bool ends_well = hex.ends_with("fafb03000000");
    EXPECT_EQ(packets_in(hex).size(), ends_well ? 1u : 0u) << vector["name"];
    if (vector.contains("hex_full_valid_packet")) {
      EXPECT_EQ(packets_in(vector["hex_full_valid_packet"]).size(), 1u) << vector["name"];
    }
  }
}

}  // namespace
}  // namespace deltamap::drivers::pioneer
