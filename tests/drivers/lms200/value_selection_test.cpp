// SPDX-License-Identifier: Apache-2.0
#include "drivers/lms200/value_selection.hpp"

#include <gtest/gtest.h>

#include <array>

#include "core/random.hpp"
#include "drivers/lms200/command.hpp"
#include "tests/support/bytes/damage.hpp"
#include "tests/support/bytes/hex.hpp"

namespace deltamap::drivers::lms200 {
namespace {

using tests::bytes_from_hex;
using tests::hex_of;
using Selected = ValueSelection::Kind;

Telegram decoded(Sender sender, const std::vector<std::uint8_t>& frame) {
  TelegramDecoder decoder{sender, 38400};
  return decoder.decode(frame, Timestamp{}).at(0);
}

Measurement measurement_of(std::size_t words, Random& random) {
  Measurement measurement;
  for (std::size_t i = 0; i < words; ++i) {
    measurement.words.push_back(static_cast<std::uint16_t>(random.index_below(0x10000)));
  }
  measurement.unit_code = 1;
  measurement.status = 0x11;
  return measurement;
}

TEST(ValueSelection, ComesBackFromItsRequests) {
  const std::vector<ValueSelection> selections{{Selected::kAll, 1, {}},
                                               {Selected::kSmallest, 1, {}},
                                               {Selected::kEverySecond, 1, {}},
                                               {Selected::kPartial, 1, {}},
                                               {Selected::kEveryTwentieth, 1, {}},
                                               {Selected::kMean, 250, {}},
                                               {Selected::kSubRange, 1, {{1, 181}}},
                                               {Selected::kMeanSubRange, 5, {{90, 270}}},
                                               {Selected::kWithReflectivity, 1, {{1, 10}, {20, 30}, {40, 41}}}};
  for (const ValueSelection& selection : selections) {
    for (const bool as_stream : {false, true}) {
      EXPECT_EQ(requested_selection(decoded(Sender::kHost, selection_request(selection, as_stream))), selection);
    }
  }
}

TEST(ValueSelection, HasTheBytesThatOtherHostsSend) {
  const auto data_of = [](const ValueSelection& selection, bool as_stream) {
    const Telegram request = decoded(Sender::kHost, selection_request(selection, as_stream));
    return hex_of(std::vector<std::uint8_t>{request.command}) + hex_of(request.data);
  };
  EXPECT_EQ(data_of({Selected::kSubRange, 1, {{1, 181}}}, true), "20270100b500") << "Player at 1 degree";
  EXPECT_EQ(data_of({Selected::kMean, 10, {}}, true), "20260a");
  EXPECT_EQ(data_of({Selected::kMeanSubRange, 10, {{1, 361}}}, true), "20280a01006901");
  EXPECT_EQ(data_of({Selected::kPartial, 1, {}}, true), "202a");
  EXPECT_EQ(data_of({Selected::kPartial, 1, {}}, false), "3008");
  EXPECT_EQ(data_of({Selected::kMean, 10, {}}, false), "360a");
  EXPECT_EQ(data_of({Selected::kSubRange, 1, {{1, 181}}}, false), "370100b500");
  EXPECT_EQ(data_of({Selected::kMeanSubRange, 10, {{1, 361}}}, false), "3f0a01006901");
}

TEST(ValueSelection, IsRefusedWhereTheDataAreNotAsListed) {
  for (const char* data :
       {"20", "2026", "202601", "2026fb", "20260505", "2027010005", "202700000500", "202705000400", "202b0000",
        "202b0600", "202b010001", "30", "3003", "300100", "36", "3601", "3701", "3f0a01"}) {
    const auto bytes = bytes_from_hex(data);
    EXPECT_FALSE(requested_selection(decoded(Sender::kHost, encoded_request(bytes[0], std::span{bytes}.subspan(1)))))
        << data;
  }
  EXPECT_FALSE(requested_selection(decoded(Sender::kHost, status_request())));
}

TEST(SelectedValues, ComeBackWithTheirLengths) {
  Random random{5};
  for (const bool has_indices : {false, true}) {
    for (const std::size_t words : {0u, 1u, 91u, 181u, 361u}) {
      for (const SelectedValues& head :
           {SelectedValues{10, std::nullopt, {}}, SelectedValues{std::nullopt, ValueRange{1, 361}, {}},
            SelectedValues{250, ValueRange{7, 8}, {}}}) {
        SelectedValues values = head;
        values.measurement = measurement_of(words, random);
        if (has_indices) values.measurement.indices = Measurement::Indices{3, 200};
        const auto frame = encoded_selected_values(values);
        const std::size_t ahead = (values.mean_of ? 1u : 0u) + (values.range ? 4u : 0u);
        EXPECT_EQ(frame.size(), ahead + 2 + 2 * words + (has_indices ? 2 : 0) + 8) << "response, status, overhead";
        const Telegram telegram = decoded(Sender::kDevice, frame);
        EXPECT_EQ(telegram.command, !values.range ? 0xB6 : !values.mean_of ? 0xB7 : 0xBF);
        EXPECT_EQ(decoded_selected_values(telegram), values);
      }
    }
  }
}

TEST(ReflectingRanges, ComeBackWithTheirLengths) {
  Random random{6};
  for (std::size_t count = 1; count <= 5; ++count) {
    std::vector<ReflectingRange> ranges;
    std::size_t size = 2 + 8;
    for (std::size_t i = 0; i < count; ++i) {
      const auto words = static_cast<std::uint16_t>(1 + random.index_below(40));
      ranges.push_back({{1, words}, measurement_of(words, random), tests::random_bytes(words, random)});
      size += 6 + 3u * words;
    }
    const auto frame = encoded_reflecting_ranges(ranges);
    EXPECT_EQ(frame.size(), size);
    EXPECT_EQ(decoded_reflecting_ranges(decoded(Sender::kDevice, frame)), ranges);
  }
}

TEST(OperatingCounters, ComeBackInFourBytes) {
  const OperatingCounters counters{1200, 300};
  const Telegram telegram = decoded(Sender::kDevice, counters_reply(counters));
  EXPECT_EQ(hex_of(telegram.data), "58022c01") << "600 times two hours, 300 starts";
  EXPECT_EQ(decoded_counters(telegram), counters);
}

TEST(PermanentBaudReply, TellsSuccessAndTheSetting) {
  const auto frame = permanent_baud_reply(true, true);
  EXPECT_EQ(frame.size(), 10u);
  const auto reply = decoded_permanent_baud_reply(decoded(Sender::kDevice, frame));
  ASSERT_TRUE(reply);
  EXPECT_TRUE(reply->accepted);
  EXPECT_TRUE(reply->is_permanent);
  EXPECT_FALSE(decoded_permanent_baud_reply(
      decoded(Sender::kDevice, encoded_reply(response::kPermanentBaud, std::vector<std::uint8_t>{1}))))
      << "a byte short";
}

TEST(Configuration2, Has84Bytes) { EXPECT_EQ(decoded(Sender::kDevice, configuration_2_reply()).data.size(), 84u); }

TEST(SelectedValues, SurviveAnyDataOfTheirTelegrams) {
  Random random{8};
  for (int round = 0; round < 20'000; ++round) {
    Telegram telegram;
    constexpr std::uint8_t kResponses[] = {0xB5, 0xB6, 0xB7, 0xBF, 0xF5, 0xE6};
    telegram.command = kResponses[random.index_below(std::size(kResponses))];
    telegram.data = tests::random_bytes(random.index_below(40), random);
    (void)decoded_selected_values(telegram);
    (void)decoded_reflecting_ranges(telegram);
    (void)decoded_counters(telegram);
    (void)decoded_permanent_baud_reply(telegram);
    telegram.command = static_cast<std::uint8_t>(telegram.command - 0x80);
    (void)requested_selection(telegram);
  }
}

TEST(CodeName, IsTheSameInEveryMode) {
  for (const auto mode : std::to_array<std::uint8_t>({0x00, 0x01, 0x02, 0x03, 0x04, 0x05, 0x06, 0x0F})) {
    const RangeCoding coding = *range_coding(mode);
    const auto name = [&](unsigned after) {
      return code_name(static_cast<std::uint16_t>(coding.beyond_maximum + after), coding).value_or("a range");
    };
    EXPECT_EQ(name(0), "beyond maximum") << int{mode};
    EXPECT_EQ(name(3), "channel 1 error") << "x..FA";
    EXPECT_EQ(name(4), "signal too weak") << "x..FB";
    EXPECT_EQ(name(6), "overflow") << "x..FD";
    EXPECT_EQ(name(7), "dazzled") << "x..FE";
    EXPECT_EQ(name(8), "not valid") << "x..FF";
    EXPECT_EQ(name(1), "code " + std::to_string(coding.beyond_maximum + 1));
    EXPECT_FALSE(code_name(static_cast<std::uint16_t>(coding.beyond_maximum - 1), coding));
    const unsigned flags = 0xFFFFu & ~coding.range_mask;
    EXPECT_EQ(code_name(static_cast<std::uint16_t>(flags | (coding.beyond_maximum + 6)), coding), "overflow");
    for (const unsigned after : {3u, 4u, 6u}) {
      const auto word = static_cast<std::uint16_t>(coding.beyond_maximum + after);
      EXPECT_EQ(decoded_beam(word, coding, 0.001, 100.0).kind, BeamKind::kOther);
    }
  }
}

}  // namespace
}  // namespace deltamap::drivers::lms200
