// SPDX-License-Identifier: Apache-2.0
#include "drivers/lms200/telegram.hpp"

#include <gtest/gtest.h>

#include "core/random.hpp"
#include "tests/support/bytes/damage.hpp"
#include "tests/support/bytes/hex.hpp"

namespace deltamap::drivers::lms200 {
namespace {

using tests::bytes_from_hex;
using tests::hex_of;
using Kind = Telegram::Kind;

constexpr unsigned kBaud = 38400;
const Timestamp kStart = timestamp_from_ns(1'700'000'000'000'000'000);

const std::vector<std::string> kRequests{"0200020020253508", "02000100311512", "020005003bb40032003b1f",
                                         "02000a0020005349434b5f4c4d53bec5"};
const std::vector<std::string> kReplies{
    "02800300a00010160a", "0280020092107f33", "02800e00b00540e803d027ff1ffe1ff71f103817",
    "02801700ba4c4d533230303b3330313036333b5630322e313020102261", "02800a00b00340028080028002106a98"};

std::vector<Telegram> decoded_whole(TelegramDecoder& decoder, std::span<const std::uint8_t> bytes) {
  std::vector<Telegram> telegrams = decoder.decode(bytes, kStart);
  for (Telegram& telegram : decoder.finish()) telegrams.push_back(std::move(telegram));
  std::erase_if(telegrams, [](const Telegram& t) { return t.kind != Kind::kTelegram; });
  return telegrams;
}

template <typename Check>
void for_both_senders(Check&& check) {
  for (const std::string& hex : kRequests) check(Sender::kHost, bytes_from_hex(hex));
  for (const std::string& hex : kReplies) check(Sender::kDevice, bytes_from_hex(hex));
}

TEST(LmsTelegram, ComputesTheCrcThatTheListingPrints) {
  EXPECT_EQ(crc16({}), 0x0000);
  EXPECT_EQ(crc16(bytes_from_hex("02")), 0x0002);
  EXPECT_EQ(crc16(bytes_from_hex("0200")), 0x0204);
  EXPECT_EQ(crc16(bytes_from_hex("313233343536373839")), 0xA656);
  EXPECT_EQ(crc16(bytes_from_hex("020002002024")), 0x0834);
}

TEST(LmsTelegram, DecodesWhatItEncodes) {
  Random random{2};
  for (std::size_t size = 0; size <= kMaxLength - 2; size += 1 + size / 9) {
    const auto data = tests::random_bytes(size, random);
    TelegramDecoder host_side{Sender::kDevice, kBaud};
    const auto replies = host_side.decode(encoded_reply(0xB0, data, 0x11), kStart);
    ASSERT_EQ(replies.size(), 1u);
    EXPECT_EQ(replies[0].command, 0xB0);
    EXPECT_EQ(replies[0].status, 0x11);
    EXPECT_EQ(replies[0].data, data);
    TelegramDecoder device_side{Sender::kHost, kBaud};
    const auto requests = device_side.decode(encoded_request(0x20, data, 5), kStart);
    ASSERT_EQ(requests.size(), 1u);
    EXPECT_EQ(requests[0].address, 5);
    EXPECT_EQ(requests[0].data, data);
  }
}

TEST(LmsTelegram, TellsHowManyBytesAreToComeOnceTheLengthIsKnown) {
  for_both_senders([](Sender sender, const tests::Bytes& frame) {
    TelegramDecoder decoder{sender, kBaud};
    EXPECT_EQ(decoder.awaited_bytes(), 0u);
    for (std::size_t i = 0; i < frame.size(); ++i) {
      (void)decoder.decode(std::span{frame}.subspan(i, 1), kStart);
      const bool knows = i + 1 >= 4;
      EXPECT_EQ(decoder.awaited_bytes(), knows ? frame.size() - i - 1 : 0) << hex_of(frame) << " after " << i + 1;
    }
  });
}

TEST(LmsTelegram, DecodesNothingFromAnyCutAndCountsIt) {
  for_both_senders([](Sender sender, const tests::Bytes& frame) {
    for (const auto& cut : tests::every_cut(frame)) {
      TelegramDecoder decoder{sender, kBaud};
      EXPECT_TRUE(decoded_whole(decoder, cut).empty()) << hex_of(cut);
      EXPECT_EQ(decoder.counts().frames, 0u);
      const bool is_lone_acknowledgement = sender == Sender::kDevice && (cut[0] == kAckByte || cut[0] == kNakByte);
      if (!is_lone_acknowledgement) {
        EXPECT_GT(decoder.counts().errors(), 0u) << hex_of(cut);
      }
    }
  });
}

TEST(LmsTelegram, DecodesNothingFromAnyFlippedBitAndCountsIt) {
  for_both_senders([](Sender sender, const tests::Bytes& frame) {
    for (const auto& flipped : tests::every_flipped_bit(frame)) {
      TelegramDecoder decoder{sender, kBaud};
      EXPECT_TRUE(decoded_whole(decoder, flipped).empty()) << hex_of(flipped);
      EXPECT_GT(decoder.counts().errors(), 0u) << hex_of(flipped);
    }
  });
}

TEST(LmsTelegram, FindsTheGoodTelegramAfterAnyDamagedOne) {
  for_both_senders([](Sender sender, const tests::Bytes& frame) {
    for (auto stream : tests::every_flipped_bit(frame)) {
      stream.insert(stream.end(), frame.begin(), frame.end());
      TelegramDecoder decoder{sender, kBaud};
      EXPECT_EQ(decoded_whole(decoder, stream).size(), 1u) << hex_of(stream);
    }
  });
}

TEST(LmsTelegram, ReadsAcknowledgementsBeforeReplies) {
  TelegramDecoder decoder{Sender::kDevice, kBaud};
  const auto telegrams = decoder.decode(bytes_from_hex("06 02800300a00010160a 15"), kStart);
  ASSERT_EQ(telegrams.size(), 3u);
  EXPECT_EQ(telegrams[0].kind, Kind::kAck);
  EXPECT_EQ(telegrams[1].kind, Kind::kTelegram);
  EXPECT_EQ(telegrams[2].kind, Kind::kNak);
  EXPECT_EQ(decoder.counts().errors(), 0u);
}

TEST(LmsTelegram, DoesNotReadAcknowledgementsOutOfGarbage) {
  TelegramDecoder decoder{Sender::kDevice, kBaud};
  EXPECT_TRUE(decoder.decode(bytes_from_hex("dc05 06 dc15 06"), kStart).empty());
  EXPECT_EQ(decoder.counts().garbage_bytes, 6u);
  // After a pause a byte is a beginning again.
  EXPECT_EQ(decoder.decode(bytes_from_hex("06"), kStart + std::chrono::milliseconds{50}).size(), 1u);
}

TEST(LmsTelegram, ReadsAcknowledgementsAgainBehindAGoodTelegram) {
  TelegramDecoder decoder{Sender::kDevice, kBaud};
  const auto telegrams = decoder.decode(bytes_from_hex("dc05 06 02800300a00010160a 06 15"), kStart);
  ASSERT_EQ(telegrams.size(), 3u);
  EXPECT_EQ(telegrams[0].kind, Kind::kTelegram);
  EXPECT_EQ(telegrams[1].kind, Kind::kAck);
  EXPECT_EQ(telegrams[2].kind, Kind::kNak);
  EXPECT_EQ(decoder.counts().garbage_bytes, 3u) << "what came before it";
}

TEST(LmsTelegram, HasNoAcknowledgementsFromTheHost) {
  TelegramDecoder decoder{Sender::kHost, kBaud};
  EXPECT_TRUE(decoder.decode(bytes_from_hex("06"), kStart).empty());
  EXPECT_EQ(decoder.counts().garbage_bytes, 1u);
}

TEST(LmsTelegram, RefusesLengthsThatCannotBeWithoutWaitingForThem) {
  TelegramDecoder decoder{Sender::kDevice, kBaud};
  const auto telegrams = decoder.decode(bytes_from_hex("0280a861b0 02800300a00010160a"), kStart);
  EXPECT_EQ(telegrams.size(), 1u);
  EXPECT_EQ(decoder.counts().bad_length, 1u);
}

TEST(LmsTelegram, GivesUpAnUnfinishedTelegramAfterALongPauseButNotAfterAShortOne) {
  const auto frame = bytes_from_hex("02800300a00010160a");
  for (const auto& [pause, found] :
       {std::pair{std::chrono::milliseconds{14}, 1u}, {std::chrono::milliseconds{900}, 0u}}) {
    TelegramDecoder decoder{Sender::kDevice, kBaud};
    EXPECT_TRUE(decoder.decode(std::span{frame}.first(4), kStart).empty());
    EXPECT_EQ(decoder.decode(std::span{frame}.subspan(4), kStart + pause).size(), found);
    EXPECT_EQ(decoder.counts().truncated, 1u - found);
  }
}

TEST(LmsTelegram, DatesStxByTheBytesThatFollowedItInItsChunk) {
  TelegramDecoder decoder{Sender::kDevice, kBaud};
  const auto telegrams = decoder.decode(bytes_from_hex("06 02800300a00010160a"), kStart);
  ASSERT_EQ(telegrams.size(), 2u);
  EXPECT_EQ(telegrams[1].first_byte, kStart - line_time(8, kBaud));
  EXPECT_EQ(telegrams[1].received, kStart);
}

TEST(LmsTelegram, FindsEveryTelegramBetweenNoiseHoweverTheStreamIsCut) {
  Random random{5};
  for (int round = 0; round < 100; ++round) {
    tests::Bytes stream;
    std::vector<tests::Bytes> sent;
    for (int i = 0; i < 10; ++i) {
      for (const std::uint8_t byte : tests::random_bytes(random.index_below(6), random)) {
        stream.push_back(byte == 0x02 ? std::uint8_t{0} : byte);
      }
      sent.push_back(tests::random_bytes(random.index_below(400), random));
      const auto frame = encoded_reply(0xB0, sent.back());
      stream.insert(stream.end(), frame.begin(), frame.end());
    }
    TelegramDecoder decoder{Sender::kDevice, kBaud};
    std::vector<tests::Bytes> found;
    tests::feed_in_chunks(stream, 100, random, [&](std::span<const std::uint8_t> chunk) {
      for (const Telegram& telegram : decoder.decode(chunk, kStart)) {
        if (telegram.kind == Kind::kTelegram) found.push_back(telegram.data);
      }
    });
    EXPECT_EQ(found, sent);
  }
}

TEST(LmsTelegram, SurvivesRandomBytesAndAccountsForEachOfThem) {
  Random random{13};
  tests::Bytes stream = tests::random_bytes(300'000, random);
  for (std::size_t i = 0; i + 3 < stream.size(); i += 70) {  // headers are rare in noise: help
    stream[i] = 0x02;
    stream[i + 1] = 0x80;
    stream[i + 3] &= 0x03;
  }
  TelegramDecoder decoder{Sender::kDevice, kBaud};
  std::size_t taken = 0;
  const auto count = [&](const std::vector<Telegram>& telegrams) {
    for (const Telegram& t : telegrams) taken += t.kind == Kind::kTelegram ? t.data.size() + 2 + kFrameOverhead : 1;
  };
  tests::feed_in_chunks(stream, 900, random, [&](auto chunk) { count(decoder.decode(chunk, kStart)); });
  count(decoder.finish());
  EXPECT_EQ(decoder.counts().garbage_bytes + taken, stream.size());
  EXPECT_GT(decoder.counts().bad_checksum, 0u);
}

}  // namespace
}  // namespace deltamap::drivers::lms200
