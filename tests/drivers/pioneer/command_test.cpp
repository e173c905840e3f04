// SPDX-License-Identifier: Apache-2.0
#include "drivers/pioneer/command.hpp"

#include <gtest/gtest.h>

#include "drivers/pioneer/packet.hpp"
#include "tests/support/bytes/hex.hpp"

namespace deltamap::drivers::pioneer {
namespace {

using tests::bytes_from_hex;
using tests::hex_of;

struct Case {
  Command command;
  const char* hex;
};

const std::vector<Case> kCases{
    {{CommandNumber::kPulse, {}}, "fafb03000000"},         {{CommandNumber::kEnable, 1}, "fafb06043b0100053b"},
    {{CommandNumber::kVel, 200}, "fafb060b3bc800d33b"},    {{CommandNumber::kDhead, -45}, "fafb060d1b2d003a1b"},
    {{CommandNumber::kSetRa, 100}, "fafb06173b64007b3b"},  {{CommandNumber::kEstop, {}}, "fafb03370037"},
    {{CommandNumber::kHostBaud, 0}, "fafb06323b0000323b"}, {{CommandNumber::kVel2, -0x04FB}, "fafb06201bfb041b1f"},
};

TEST(PioneerCommand, HasTheBytesThatTheManualPrints) {
  for (const Case& c : kCases) {
    EXPECT_EQ(hex_of(encoded_command(c.command)), c.hex) << command_name(c.command.number);
    const auto frame = bytes_from_hex(c.hex);
    const auto data = std::span{frame}.subspan(3, frame.size() - kFrameOverhead);
    EXPECT_EQ(decoded_command(data), c.command) << command_name(c.command.number);
  }
}

TEST(PioneerCommand, CarriesStrings) {
  const Command polling{CommandNumber::kPolling, std::string("\x01\x02\xFA\xFB")};
  const auto frame = encoded_command(polling);
  EXPECT_EQ(decoded_command(std::span{frame}.subspan(3, frame.size() - kFrameOverhead)), polling);
}

TEST(PioneerCommand, ReadsTheMalformedSetoOfOldClients) {
  EXPECT_EQ(decoded_command(bytes_from_hex("073b")), (Command{CommandNumber::kSetO, {}}));
}

TEST(PioneerCommand, IgnoresArgumentsAfterTheFirst) {
  EXPECT_EQ(decoded_command(bytes_from_hex("073b0100 3b0200 3b0300")), (Command{CommandNumber::kSetO, 1}));
}

TEST(PioneerCommand, RefusesArgumentsThatAreCutOrOfAnUnknownKind) {
  for (const char* hex : {"0b3bc8", "0b99c800", "032b05fafb", ""}) {
    EXPECT_FALSE(decoded_command(bytes_from_hex(hex))) << hex;
  }
}

TEST(PioneerCommand, NegatesAWheelPairBeforeSplittingIt) {
  EXPECT_EQ(byte_pair(-0x04FB), (BytePair{-5, 5}));
  EXPECT_EQ(byte_pair(0x05FB), (BytePair{5, -5}));
  EXPECT_EQ(byte_pair(byte_pair_command(CommandNumber::kVel2, {-128, 127}).integer_or(0)), (BytePair{-128, 127}));
}

TEST(PioneerCommand, CodesTheFiveSpeedsOfTheHostPort) {
  for (const unsigned baud : {9600u, 19200u, 38400u, 57600u, 115200u}) {
    ASSERT_TRUE(host_baud_code(baud));
    EXPECT_EQ(baud_of_host_code(*host_baud_code(baud)), baud);
  }
  EXPECT_FALSE(host_baud_code(4800));
  EXPECT_FALSE(baud_of_host_code(5));
  EXPECT_FALSE(baud_of_host_code(-1));
}

}  // namespace
}  // namespace deltamap::drivers::pioneer
