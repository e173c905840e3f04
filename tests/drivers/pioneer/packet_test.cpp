// SPDX-License-Identifier: Apache-2.0
#include "drivers/pioneer/packet.hpp"

#include <gtest/gtest.h>

#include "core/random.hpp"
#include "tests/support/bytes/damage.hpp"
#include "tests/support/bytes/hex.hpp"

namespace deltamap::drivers::pioneer {
namespace {

using tests::bytes_from_hex;
using tests::hex_of;

constexpr unsigned kBaud = 9600;
const Timestamp kStart = timestamp_from_ns(1'700'000'000'000'000'000);

const std::vector<std::string> kFrames{
    "fafb03000000",            // SYNC0
    "fafb060b3bc800d33b",      // VEL 200
    "fafb060d1b2d003a1b",      // DHEAD -45
    "fafb08032b03fafb010226",  // POLLING with FA FB inside
    "fafb22320000000000000000000080000000001f000000000000ffff8000000000000051ff",
    "fafb1802414d524953696d0050696f6e656572007033647800ebbd",
};

std::vector<Packet> decoded_whole(PacketDecoder& decoder, std::span<const std::uint8_t> bytes) {
  std::vector<Packet> packets = decoder.decode(bytes, kStart);
  for (Packet& packet : decoder.finish()) packets.push_back(std::move(packet));
  return packets;
}

TEST(PioneerPacket, DecodesWhatItEncodes) {
  Random random{1};
  for (std::size_t size = 1; size <= kMaxData; ++size) {
    const auto data = tests::random_bytes(size, random);
    PacketDecoder decoder{kBaud};
    const auto packets = decoder.decode(encoded_packet(data), kStart);
    ASSERT_EQ(packets.size(), 1u);
    EXPECT_EQ(packets[0].data, data);
    EXPECT_EQ(decoder.counts().errors(), 0u);
  }
}

TEST(PioneerPacket, SumsAnOddLastByteIntoTheLowByte) {
  EXPECT_EQ(checksum(bytes_from_hex("0b3bc800")), 0xD33B);
  EXPECT_EQ(checksum(bytes_from_hex("032b03fafb01")), 0x0226);
  EXPECT_EQ(checksum(bytes_from_hex("37")), 0x0037);
}

TEST(PioneerPacket, TellsHowManyBytesAreToComeOnceTheByteCountIsKnown) {
  for (const std::string& hex : kFrames) {
    const auto frame = bytes_from_hex(hex);
    PacketDecoder decoder{kBaud};
    EXPECT_EQ(decoder.awaited_bytes(), 0u);
    for (std::size_t i = 0; i < frame.size(); ++i) {
      (void)decoder.decode(std::span{frame}.subspan(i, 1), kStart);
      EXPECT_EQ(decoder.awaited_bytes(), i + 1 >= 3 ? frame.size() - i - 1 : 0) << hex << " after " << i + 1;
    }
  }
}

TEST(PioneerPacket, DecodesNothingFromAnyCutAndCountsIt) {
  for (const std::string& hex : kFrames) {
    for (const auto& cut : tests::every_cut(bytes_from_hex(hex))) {
      PacketDecoder decoder{kBaud};
      EXPECT_TRUE(decoded_whole(decoder, cut).empty()) << hex_of(cut) << " of " << hex;
      EXPECT_GT(decoder.counts().errors(), 0u) << hex_of(cut);
      EXPECT_EQ(decoder.counts().frames, 0u);
    }
  }
}

TEST(PioneerPacket, DecodesNothingFromAnyFlippedBitAndCountsIt) {
  for (const std::string& hex : kFrames) {
    for (const auto& flipped : tests::every_flipped_bit(bytes_from_hex(hex))) {
      PacketDecoder decoder{kBaud};
      EXPECT_TRUE(decoded_whole(decoder, flipped).empty()) << hex_of(flipped) << " of " << hex;
      EXPECT_GT(decoder.counts().errors(), 0u) << hex_of(flipped);
    }
  }
}

TEST(PioneerPacket, FindsTheGoodPacketAfterAnyDamagedOne) {
  const auto good = bytes_from_hex("fafb060b3bc800d33b");
  for (const std::string& hex : kFrames) {
    for (auto stream : tests::every_flipped_bit(bytes_from_hex(hex))) {
      stream.insert(stream.end(), good.begin(), good.end());
      PacketDecoder decoder{kBaud};
      const auto packets = decoded_whole(decoder, stream);
      ASSERT_EQ(packets.size(), 1u) << hex_of(stream);
      EXPECT_EQ(hex_of(packets[0].data), "0b3bc800");
    }
  }
}

TEST(PioneerPacket, SkipsTheChatterThatClientsSendToRadioModems) {
  PacketDecoder decoder{kBaud};
  const auto packets = decoder.decode(bytes_from_hex("574d53320d fafb03000000"), kStart);
  ASSERT_EQ(packets.size(), 1u);
  EXPECT_EQ(decoder.counts().garbage_bytes, 5u);
}

TEST(PioneerPacket, TakesAHeaderWhoseFirstByteIsDoubled) {
  PacketDecoder decoder{kBaud};
  EXPECT_EQ(decoder.decode(bytes_from_hex("fa fafb03000000"), kStart).size(), 1u);
}

TEST(PioneerPacket, RefusesByteCountsThatCannotBe) {
  for (const char* hex : {"fafbff0000000000000000", "fafbcd", "fafb02 0000", "fafb00"}) {
    PacketDecoder decoder{kBaud};
    EXPECT_TRUE(decoded_whole(decoder, bytes_from_hex(hex)).empty());
    EXPECT_EQ(decoder.counts().bad_length, 1u) << hex;
    EXPECT_EQ(decoder.counts().truncated, 0u) << hex;
  }
}

TEST(PioneerPacket, GivesUpAnUnfinishedPacketAfterALongPause) {
  PacketDecoder decoder{kBaud};
  EXPECT_TRUE(decoder.decode(bytes_from_hex("fafb c0 33"), kStart).empty());
  const auto packets = decoder.decode(bytes_from_hex("fafb03000000"), kStart + std::chrono::seconds{1});
  EXPECT_EQ(packets.size(), 1u);
  EXPECT_EQ(decoder.counts().truncated, 1u);
}

TEST(PioneerPacket, DropsWhatIsHalfReceivedWhenTheSpeedChanges) {
  PacketDecoder decoder{kBaud};
  EXPECT_TRUE(decoder.decode(bytes_from_hex("fafb0600"), kStart).empty());
  decoder.set_baud(38400);
  EXPECT_EQ(decoder.decode(bytes_from_hex("fafb03000000"), kStart).size(), 1u);
  EXPECT_EQ(decoder.counts().truncated, 1u);
}

TEST(PioneerPacket, DatesTheFirstByteByTheBytesThatFollowedItInItsChunk) {
  PacketDecoder decoder{kBaud};
  const auto packets = decoder.decode(bytes_from_hex("fafb060b3bc800d33b"), kStart);
  ASSERT_EQ(packets.size(), 1u);
  EXPECT_EQ(packets[0].first_byte, kStart - line_time(8, kBaud));
  EXPECT_EQ(packets[0].received, kStart);
}

TEST(PioneerPacket, DatesTheFirstByteByTheChunkThatWasReadSoonest) {
  // The first chunk lay in a buffer for 20 ms; the second was read as it came.
  PacketDecoder decoder{kBaud};
  EXPECT_TRUE(decoder.decode(bytes_from_hex("fafb06"), kStart + std::chrono::milliseconds{20}).empty());
  const Timestamp second = kStart + std::chrono::milliseconds{21};
  const auto packets = decoder.decode(bytes_from_hex("0b3bc800d33b"), second);
  ASSERT_EQ(packets.size(), 1u);
  EXPECT_EQ(packets[0].first_byte, second - line_time(8, kBaud));
  EXPECT_EQ(packets[0].received, second);
}

TEST(PioneerPacket, FindsEveryPacketBetweenNoiseHoweverTheStreamIsCut) {
  Random random{7};
  for (int round = 0; round < 200; ++round) {
    tests::Bytes stream;
    std::vector<tests::Bytes> sent;
    for (int i = 0; i < 20; ++i) {
      for (const std::uint8_t byte : tests::random_bytes(random.index_below(6), random)) {
        stream.push_back(byte == 0xFA ? std::uint8_t{0} : byte);
      }
      sent.push_back(tests::random_bytes(1 + random.index_below(40), random));
      const auto frame = encoded_packet(sent.back());
      stream.insert(stream.end(), frame.begin(), frame.end());
    }
    PacketDecoder decoder{kBaud};
    std::vector<tests::Bytes> found;
    tests::feed_in_chunks(stream, 16, random, [&](std::span<const std::uint8_t> chunk) {
      for (const Packet& packet : decoder.decode(chunk, kStart)) found.push_back(packet.data);
    });
    EXPECT_EQ(found, sent);
  }
}

TEST(PioneerPacket, SurvivesRandomBytesAndAccountsForEachOfThem) {
  Random random{11};
  std::size_t taken = 0;
  PacketDecoder decoder{kBaud};
  tests::Bytes stream = tests::random_bytes(200'000, random);
  for (std::size_t i = 0; i + 1 < stream.size(); i += 50) {  // headers are rare in noise: help
    stream[i] = 0xFA;
    stream[i + 1] = 0xFB;
  }
  const auto count = [&](const std::vector<Packet>& packets) {
    for (const Packet& packet : packets) taken += packet.data.size() + kFrameOverhead;
  };
  tests::feed_in_chunks(stream, 300, random, [&](auto chunk) { count(decoder.decode(chunk, kStart)); });
  count(decoder.finish());
  EXPECT_EQ(decoder.counts().garbage_bytes + taken, stream.size());
  EXPECT_GT(decoder.counts().bad_checksum, 0u);
}

}  // namespace
}  // namespace deltamap::drivers::pioneer
