// SPDX-License-Identifier: Apache-2.0
#include "simulation/devices/virtual_lms200.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <ostream>

#include "drivers/lms200/command.hpp"
#include "drivers/lms200/measurement.hpp"
#include "drivers/lms200/status.hpp"
#include "drivers/lms200/value_selection.hpp"
#include "tests/support/scans/lms200_rig.hpp"

namespace deltamap::simulation::devices {
namespace {

using Kind = lms200::Telegram::Kind;

TEST(VirtualLms200, AcknowledgesThenAnswersTheStatus) {
  Lms200Rig rig;
  const auto answers = rig.ask(lms200::status_request());
  ASSERT_EQ(answers.size(), 2u);
  EXPECT_EQ(answers[0].kind, Kind::kAck);
  EXPECT_LE(answers[0].received - (kPowerOn + std::chrono::seconds{1}), std::chrono::milliseconds{60}) << "B1";
  const auto status = lms200::decoded_status(answers[1]);
  ASSERT_TRUE(status);
  EXPECT_EQ(status->resolution_centideg, 50);
  EXPECT_EQ(status->baud(), 9600u);
}

TEST(VirtualLms200, OfAnLmsFastKeepsItsVariant) {
  Lms200Rig rig{{.variant = {90, 50}, .has_fixed_variant = true}};
  for (const char* name : {"180/1", "180/0.5", "100/1", "100/0.5", "100/0.25", "90/0.5"}) {
    const auto answers = rig.ask(lms200::variant_request(lms200::variant_named(name).value()), 2.0);
    const auto reply = lms200::decoded_variant_reply(answers.at(1));
    ASSERT_TRUE(reply) << name;
    EXPECT_EQ(reply->accepted, std::string(name) == "90/0.5") << name;
    EXPECT_EQ(lms200::name_of(reply->active), "90/0.5");
  }
  EXPECT_FALSE(lms200::decoded_variant_reply(Lms200Rig{}.ask(lms200::variant_request({90, 50}), 2.0).at(1))->accepted)
      << "others do not have it";
}

TEST(VirtualLms200, RefusesADamagedTelegramWithNakAndIgnoresOtherAddresses) {
  Lms200Rig rig;
  auto damaged = lms200::status_request();
  damaged.back() ^= 0x01;
  const auto answers = rig.ask(damaged);
  ASSERT_EQ(answers.size(), 1u);
  EXPECT_EQ(answers[0].kind, Kind::kNak);
  EXPECT_TRUE(rig.ask(lms200::encoded_request(lms200::command::kRequestStatus, {}, 0x05)).empty());
}

TEST(VirtualLms200, AnswersNothingReadableAtAnotherBaud) {
  Lms200Rig rig;
  for (const unsigned baud : {19200u, 38400u, 500000u}) {
    rig.set_host_baud(baud);
    for (int i = 0; i < 5; ++i) {
      for (const auto& answer : rig.ask(lms200::status_request(), 0.2)) EXPECT_NE(answer.kind, Kind::kTelegram) << baud;
    }
  }
}

TEST(VirtualLms200, ChangesItsBaudAfterTheAnswerAtTheOldOne) {
  Lms200Rig rig;
  const auto answers = rig.ask(lms200::baud_request(500000));
  ASSERT_EQ(answers.size(), 2u);
  EXPECT_TRUE(lms200::mode_was_switched(answers[1]).value_or(false));
  EXPECT_EQ(rig.laser.baud(), 500000u);
  rig.set_host_baud(500000);
  EXPECT_EQ(rig.ask(lms200::status_request()).size(), 2u);
}

struct RateCase {
  lms200::ScanVariant variant;
  unsigned baud;
  int every;  // nth scan, table B7

  friend std::ostream& operator<<(std::ostream& out, const RateCase& one) {
    return out << name_of(one.variant) << " at " << one.baud;
  }
};

class ScanRate : public ::testing::TestWithParam<RateCase> {};

TEST_P(ScanRate, FollowsFromTheBaudAsInTableB7) {
  const auto [variant, baud, every] = GetParam();
  Lms200Setup setup;
  setup.baud = baud;
  setup.variant = variant;
  Lms200Rig rig{setup};
  rig.stream();
  (void)rig.pass(5.0);
  ASSERT_GE(rig.sweeps.size(), 4u);
  for (std::size_t i = 2; i < rig.sweeps.size(); ++i) {
    EXPECT_NEAR(seconds(rig.sweeps[i].begin - rig.sweeps[i - 1].begin), every * variant.scan_duration_s(), 1e-6);
  }
}

INSTANTIATE_TEST_SUITE_P(TableB7, ScanRate,
                         ::testing::Values(RateCase{{180, 100}, 9600, 30}, RateCase{{180, 100}, 19200, 15},
                                           RateCase{{180, 100}, 38400, 8}, RateCase{{180, 100}, 500000, 1},
                                           RateCase{{180, 50}, 9600, 29}, RateCase{{180, 50}, 19200, 15},
                                           RateCase{{180, 50}, 38400, 8}, RateCase{{180, 50}, 500000, 1},
                                           RateCase{{100, 25}, 9600, 16}, RateCase{{100, 25}, 19200, 8},
                                           RateCase{{100, 25}, 38400, 4}, RateCase{{100, 25}, 500000, 1}));

TEST(VirtualLms200, LetsTheReceiverFindTheTimeOfTheFirstBeam) {
  for (const unsigned baud : {9600u, 38400u, 500000u}) {
    Lms200Setup setup;
    setup.baud = baud;
    Lms200Rig rig{setup};
    rig.stream();
    std::size_t scans = 0;
    const std::size_t skipped = rig.sweeps.size();
    for (const auto& telegram : rig.pass(4.0)) {
      const auto measurement = lms200::decoded_measurement(telegram);
      if (!measurement) continue;
      const auto scan = lms200::scan_from(*measurement, {}, telegram.first_byte, telegram.received);
      ASSERT_TRUE(scan);
      if (skipped == 0) {
        const double late_s = seconds(scan->time - rig.sweeps[scans].begin);
        EXPECT_NEAR(late_s, 0.0, 2.1 * 10.0 / baud) << "within two bytes at " << baud;
      }
      ++scans;
    }
    EXPECT_GT(scans, 3u);
  }
}

TEST(VirtualLms200, TellsRangesInItsUnitAndCodesWhereThereAreNone) {
  Lms200Setup setup;
  setup.baud = 500000;
  Lms200Rig rig{setup};
  rig.range_m = 5.126F;
  rig.stream();
  auto measurement = lms200::decoded_measurement(rig.pass(0.1).at(0));
  ASSERT_TRUE(measurement);
  EXPECT_EQ(measurement->unit_code, 0);
  EXPECT_EQ(measurement->words.size(), 361u);
  EXPECT_EQ(measurement->words[100], 513) << "cm";
  EXPECT_NEAR(rig.sweeps.back().max_range_m, 81.82, 1e-9);
  rig.kind = BeamKind::kBeyondMaximum;
  (void)rig.pass(0.1);
  measurement = lms200::decoded_measurement(rig.pass(0.1).at(0));
  EXPECT_EQ(measurement->words[100], 0x1FF7);
}

TEST(VirtualLms200, WritesItsConfigurationOnlyInInstallationMode) {
  Lms200Rig rig;
  lms200::Configuration wanted = rig.laser.configuration();
  wanted.set_units(lms200::Units::kMillimetre);
  wanted.set_measuring_mode(0x06);
  auto answers = rig.ask(lms200::write_configuration_request(wanted));
  EXPECT_EQ(answers.at(1).command, lms200::response::kRefused);
  answers = rig.ask(lms200::installation_request("SICK_BAD"));
  EXPECT_FALSE(lms200::mode_was_switched(answers.at(1)).value_or(true));
  answers = rig.ask(lms200::installation_request());
  EXPECT_TRUE(lms200::mode_was_switched(answers.at(1)).value_or(false));
  answers = rig.ask(lms200::write_configuration_request(wanted));
  const auto reply = lms200::decoded_write_reply(answers.at(1));
  ASSERT_TRUE(reply && reply->accepted);
  EXPECT_EQ(reply->active, wanted);
  EXPECT_EQ(rig.laser.configuration_writes(), 1);
  EXPECT_EQ(lms200::decoded_configuration(rig.ask(lms200::configuration_request()).at(1)), wanted);
}

TEST(VirtualLms200, TakesPossibleVariantsAndRefusesOthers) {
  Lms200Rig rig;
  auto reply = lms200::decoded_variant_reply(rig.ask(lms200::variant_request({100, 25})).at(1));
  ASSERT_TRUE(reply);
  EXPECT_TRUE(reply->accepted);
  reply = lms200::decoded_variant_reply(rig.ask(lms200::variant_request({180, 25})).at(1));
  ASSERT_TRUE(reply);
  EXPECT_FALSE(reply->accepted);
  EXPECT_EQ(reply->active, (lms200::ScanVariant{100, 25}));
}

TEST(VirtualLms200, InterruptsItsOutputForARequestAndStopsTheStream) {
  Lms200Rig rig;
  rig.stream();
  (void)rig.pass(1.1);  // in the middle of a scan at 9600
  rig.discard_input();
  const auto answers = rig.ask(lms200::mode_request(lms200::mode::kOnRequest), 0.2);
  ASSERT_FALSE(answers.empty());
  EXPECT_EQ(answers.back().command, lms200::response::kMode);
  EXPECT_FALSE(rig.laser.is_streaming());
  EXPECT_TRUE(rig.pass(2.0).empty());
}

TEST(VirtualLms200, DropsATelegramWhoseHostPausedInTheMiddle) {
  Lms200Rig rig;
  const auto request = lms200::status_request();
  rig.laser.receive(std::span{request}.first(4), 9600, rig.now);
  (void)rig.pass(0.2);
  EXPECT_EQ(rig.ask(request).size(), 2u) << "the half one does not spoil the next";
}

TEST(VirtualLms200, AnswersCountersConfiguration2AndPermanentBaudInFull) {
  Lms200Setup setup;
  setup.baud = 38400;
  Lms200Rig rig{setup};
  const auto size_of = [&](const std::vector<std::uint8_t>& request) { return answer_of(rig, request).data.size(); };
  EXPECT_EQ(size_of(lms200::encoded_request(0x35, {})), 4u);
  EXPECT_EQ(size_of(lms200::encoded_request(0x7B, {})), 84u);
  EXPECT_EQ(size_of(lms200::permanent_baud_request(true)), 2u);
  EXPECT_EQ(size_of(lms200::configuration_request()), 34u);
  EXPECT_EQ(size_of(lms200::status_request()), 152u);
  EXPECT_EQ(size_of(lms200::variant_request({180, 50})), 5u);
  EXPECT_EQ(size_of(lms200::mode_request(lms200::mode::kOnRequest)), 1u);
}

TEST(VirtualLms200, AnnouncesItselfAt9600AfterAPowerCut) {
  Lms200Setup setup;
  setup.baud = 38400;
  Lms200Rig rig{setup};
  rig.stream();
  rig.laser.cut_power(rig.now);
  rig.set_host_baud(9600);
  EXPECT_TRUE(rig.ask(lms200::status_request(), 2.9).empty()) << "silent while it starts";
  const auto announced = rig.pass(0.5);
  ASSERT_EQ(announced.size(), 1u);
  EXPECT_EQ(announced[0].command, lms200::response::kPowerOn);
  EXPECT_EQ(rig.laser.baud(), 9600u);
}

TEST(VirtualLms200, KeepsAPermanentBaudOverAPowerCut) {
  Lms200Rig rig;
  (void)rig.ask(lms200::permanent_baud_request(true));
  (void)rig.ask(lms200::baud_request(38400));
  rig.laser.cut_power(rig.now);
  rig.set_host_baud(38400);
  EXPECT_EQ(rig.pass(3.5).size(), 1u);
}

TEST(VirtualLms200, RefusesWhatItCannotDoWith92) {
  Lms200Rig rig;
  EXPECT_EQ(rig.ask(lms200::encoded_request(0x55, {})).at(1).command, lms200::response::kRefused);
}

}  // namespace
}  // namespace deltamap::simulation::devices
