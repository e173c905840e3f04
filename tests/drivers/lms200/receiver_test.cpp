// SPDX-License-Identifier: Apache-2.0
#include "drivers/lms200/receiver.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "drivers/lms200/command.hpp"
#include "drivers/lms200/measurement.hpp"
#include "drivers/lms200/status.hpp"

namespace deltamap::drivers::lms200 {
namespace {

using Bytes = std::vector<std::uint8_t>;

const Timestamp kNow = timestamp_from_ns(1'700'000'000'000'000'000);

Bytes scan_telegram(unsigned values = 181) {
  Measurement measurement;
  measurement.words.assign(values, 1500);
  measurement.unit_code = 1;
  return encoded_measurement(measurement);
}

std::vector<Scan> scans_of(Receiver& receiver, const Bytes& bytes, Timestamp stamp = kNow) {
  std::vector<Scan> scans;
  for (const Telegram& telegram : receiver.decode(bytes, stamp).telegrams) {
    Receiver::Content content = receiver.take(telegram);
    if (content.scan) scans.push_back(std::move(*content.scan));
  }
  return scans;
}

TEST(Receiver, AnswersNoScanBeforeTheLaserHasToldItsModeAndNumbersThoseAfterIt) {
  Receiver receiver{Lms200Params{}, SessionMode::kLive};
  EXPECT_TRUE(scans_of(receiver, scan_telegram()).empty());
  (void)scans_of(receiver, status_reply(DeviceStatus{}));
  EXPECT_EQ(scans_of(receiver, scan_telegram()).at(0).number, 0u);
  EXPECT_EQ(scans_of(receiver, scan_telegram()).at(0).number, 1u);
  receiver.forget_mode();
  EXPECT_TRUE(scans_of(receiver, scan_telegram()).empty());
}

TEST(Receiver, KnowsWhatTheLaserHasSaidUntilItIsStartedUpAnew) {
  Receiver receiver{Lms200Params{}, SessionMode::kLive};
  DeviceStatus status;
  status.measuring_mode = 3;
  status.scan_angle_deg = 100;
  (void)scans_of(receiver, status_reply(status));
  EXPECT_EQ(receiver.measuring_mode(), std::uint8_t{3});
  EXPECT_EQ(receiver.variant(), (ScanVariant{100, 100}));
  EXPECT_FALSE(receiver.configuration());
  Configuration configuration;
  configuration.set_measuring_mode(5);
  (void)scans_of(receiver, configuration_reply(configuration));
  (void)scans_of(receiver, variant_reply(true, {180, 50}));
  EXPECT_EQ(receiver.measuring_mode(), std::uint8_t{5});
  EXPECT_EQ(receiver.configuration(), configuration);
  EXPECT_EQ(receiver.variant(), (ScanVariant{180, 50}));
  const auto telegrams = receiver.decode(power_on_reply("LMS200;301063;V02.10 "), kNow).telegrams;
  ASSERT_EQ(telegrams.size(), 1u);
  EXPECT_EQ(receiver.take(telegrams[0]).log, std::vector<std::string>{"laser has started up"});
  EXPECT_FALSE(receiver.measuring_mode() || receiver.variant() || receiver.configuration());
}

TEST(Receiver, PointsBeamsByTheVariantThatTheLaserTells) {
  Receiver receiver{Lms200Params{.variant = {180, 100}}, SessionMode::kLive};
  DeviceStatus status;
  status.scan_angle_deg = 90;
  status.resolution_centideg = 50;
  (void)scans_of(receiver, status_reply(status));
  const Scan by_status = scans_of(receiver, scan_telegram()).at(0);
  EXPECT_NEAR(degrees(by_status.first_bearing_rad), -45.0, 1e-9);
  EXPECT_NEAR(degrees(by_status.bearing_step_rad), 0.5, 1e-9);
  (void)scans_of(receiver, variant_reply(true, {180, 100}));
  EXPECT_NEAR(degrees(scans_of(receiver, scan_telegram()).at(0).first_bearing_rad), -90.0, 1e-9);
}

TEST(Receiver, AnswersNoScanOfAVariantThatItDoesNotKnowAndWarnsOnce) {
  Receiver receiver{Lms200Params{}, SessionMode::kLive};
  std::vector<std::string> warnings;
  const auto take = [&](const Bytes& bytes) {
    std::size_t scans = 0;
    for (const Telegram& telegram : receiver.decode(bytes, kNow).telegrams) {
      const Receiver::Content content = receiver.take(telegram);
      warnings.insert(warnings.end(), content.warnings.begin(), content.warnings.end());
      scans += content.scan ? 1 : 0;
    }
    return scans;
  };
  DeviceStatus status;
  status.scan_angle_deg = 90;
  status.resolution_centideg = 25;
  for (int i = 0; i < 3; ++i) {
    EXPECT_EQ(take(status_reply(status)), 0u);
    EXPECT_EQ(take(scan_telegram(361)), 0u);
  }
  ASSERT_EQ(warnings.size(), 1u);
  EXPECT_EQ(warnings[0].find("laser tells variant=90/25e-2, which is not known here"), 0u) << warnings[0];
  EXPECT_EQ(take(variant_reply(true, {180, 50})), 0u);
  EXPECT_EQ(take(scan_telegram(361)), 1u);
}

TEST(Receiver, TakesTheBeamsOfIgnoredBearingsForNotValid) {
  for (const bool is_upside_down : {false, true}) {
    Receiver receiver{Lms200Params{.is_upside_down = is_upside_down,
                                   .ignored = {{radians(-30.0), radians(-20.0)}, {radians(88.0), radians(180.0)}}},
                      SessionMode::kLive};
    (void)scans_of(receiver, status_reply(DeviceStatus{}));
    const Scan scan = scans_of(receiver, scan_telegram()).at(0);
    for (std::size_t i = 0; i < scan.beams.size(); ++i) {
      const long bearing_deg = std::lround(degrees(scan.bearing_rad(i)));
      const bool is_ignored = (bearing_deg >= -30 && bearing_deg <= -20) || bearing_deg >= 88;
      EXPECT_EQ(scan.beams[i].kind, is_ignored ? BeamKind::kNotValid : BeamKind::kRange) << bearing_deg;
    }
  }
}

TEST(Receiver, WantsTheConfigurationOfTheLaserButForUnitsAndMode) {
  Receiver receiver{{.units = Units::kMillimetre, .measuring_mode = std::uint8_t{5}}, SessionMode::kLive};
  Configuration told;
  told.bytes[9] = 77;
  told.set_units(Units::kCentimetre);
  (void)scans_of(receiver, configuration_reply(told));
  Configuration wanted = told;
  wanted.set_units(Units::kMillimetre);
  wanted.set_measuring_mode(5);
  EXPECT_EQ(receiver.wanted_configuration(), wanted);
}

TEST(Receiver, FollowsTheSpeedInTheStatusOnlyInARecording) {
  DeviceStatus status;
  status.baud_code = *baud_code(19200);
  for (const SessionMode mode : {SessionMode::kLive, SessionMode::kListenOnly}) {
    Receiver receiver{Lms200Params{}, mode};
    (void)scans_of(receiver, status_reply(status));
    EXPECT_EQ(receiver.baud(), mode == SessionMode::kLive ? 38400u : 19200u);
  }
}

TEST(Receiver, TellsGarbageFromTheBeginningOfATelegram) {
  Receiver receiver{Lms200Params{}, SessionMode::kLive};
  const Bytes frame = scan_telegram();
  const auto begin = receiver.decode(std::span{frame}.first(100), kNow);
  EXPECT_TRUE(begin.telegrams.empty());
  EXPECT_FALSE(begin.has_garbage);
  EXPECT_EQ(receiver.decode(std::span{frame}.subspan(100), kNow).telegrams.size(), 1u);
  EXPECT_TRUE(receiver.decode(Bytes{0x55, 0xAA, 0x55}, kNow).has_garbage);
}

}  // namespace
}  // namespace deltamap::drivers::lms200
