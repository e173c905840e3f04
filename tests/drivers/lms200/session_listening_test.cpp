// SPDX-License-Identifier: Apache-2.0
// Recordings: the same scans as live, and what is assumed where the laser does not tell it.
#include "tests/drivers/lms200/session_fixture.hpp"

namespace deltamap::drivers::lms200 {
namespace {

TEST_F(Lms200SessionTest, DatesScansByTheLineAndTheMirror) {
  ASSERT_TRUE(stream());
  line.run_for(1.0);
  const Scan& scan = line.messages.back();
  const double expected_age_s = seconds(line_time(731, 38400)) + 0.02664;
  EXPECT_NEAR(seconds(scan.received - scan.time), expected_age_s, 1e-6);
}

TEST_F(Lms200SessionTest, ListeningToTheRecordingGivesTheSameScansAndWritesNothing) {
  laser.is_streaming = true;
  laser = FakeLaser{38400};
  laser.is_streaming = true;
  ASSERT_TRUE(stream());
  line.run_for(3.0);
  expect_the_recording_to_tell_the_same();
}

TEST_F(Lms200SessionTest, GoesOnInOrderAfterAStandstillAndTheRecordingTellsTheSame) {
  use({.variant = {180, 100}});
  ASSERT_TRUE(stream());
  for (const std::size_t piece : {std::size_t{62}, std::size_t{600}, std::size_t{4096}}) {
    line.run_for(1.0);
    line.stand_still_for(0.9, piece);
  }
  line.run_for(1.0);
  EXPECT_GT(line.messages.size(), 40u);
  for (std::size_t i = 1; i < line.messages.size(); ++i) {
    EXPECT_GT(line.messages[i].time, line.messages[i - 1].time) << i;
  }
  expect_the_recording_to_tell_the_same();
}

TEST(Lms200Listening, AssumesTheWantedModeWhereARecordingNeverTellsIt) {
  Lms200Session listener{{.measuring_mode = std::uint8_t{6}, .baud = 500000, .assume_after_s = 5.0},
                         SessionMode::kListenOnly};
  Measurement measurement;
  measurement.words.assign(361, 9000 | 0x8000);
  measurement.unit_code = 1;
  const auto frame = encoded_measurement(measurement);
  const Timestamp begin = timestamp_from_ns(1'700'000'000'000'000'000);
  EXPECT_TRUE(listener.on_bytes(frame, begin).scans.empty());
  const auto scans = listener.on_bytes(frame, begin + std::chrono::seconds{5}).scans;
  ASSERT_EQ(scans.size(), 1u);
  EXPECT_FLOAT_EQ(scans[0].beams[0].range_m, 9.0F);
}

TEST(Lms200Listening, PassesOnWhatTheLaserSaysOfItsHealthAndTellsEachChangeOnce) {
  Lms200Session listener{{.baud = 500000}, SessionMode::kListenOnly};
  (void)listener.on_bytes(status_reply(DeviceStatus{}), Timestamp{});
  Measurement measurement;
  measurement.words.assign(181, 1500);
  std::vector<std::string> log;
  const auto hear = [&](std::uint8_t status) {
    measurement.status = status;
    Lms200Output out = listener.on_bytes(encoded_measurement(measurement), Timestamp{});
    log.insert(log.end(), out.output.log.begin(), out.output.log.end());
    return out.scans.at(0);
  };
  EXPECT_EQ(hear(kNormalStatus).severity, 0);
  EXPECT_EQ(hear(0x14).severity, 4);
  const Scan implausible = hear(0xD0);
  EXPECT_EQ(implausible.severity, 0);
  EXPECT_TRUE(implausible.implausible);
  (void)hear(0xD0);
  EXPECT_EQ(log, (std::vector<std::string>{"laser status severity=4",
                                           "laser status severity=0 values=implausible window=dirty"}));
}

TEST(Lms200Listening, LearnsTheLineSpeedFromTheStatusUnlessTheRecordingSaysIt) {
  DeviceStatus status;
  status.baud_code = *baud_code(500000);
  Lms200Session listener{Lms200Params{}, SessionMode::kListenOnly};
  (void)listener.on_bytes(status_reply(status), Timestamp{});
  EXPECT_EQ(listener.baud(), 500000u);
  Lms200Session told{Lms200Params{}, SessionMode::kListenOnly};
  told.on_baud(19200);
  (void)told.on_bytes(status_reply(status), Timestamp{});
  EXPECT_EQ(told.baud(), 19200u);
}

TEST(Lms200Listening, CountsWhatItCannotRead) {
  Lms200Session listener{Lms200Params{}, SessionMode::kListenOnly};
  (void)listener.on_bytes(encoded_reply(response::kScan, std::vector<std::uint8_t>{5, 0}), Timestamp{});
  (void)listener.on_bytes(encoded_reply(response::kStatus, std::vector<std::uint8_t>{5, 0}), Timestamp{});
  (void)listener.on_bytes(encoded_reply(0xDD, std::vector<std::uint8_t>{5, 0}), Timestamp{});
  EXPECT_EQ(listener.counts().malformed, 2u);
  EXPECT_EQ(listener.counts().unknown, 1u);
  EXPECT_EQ(listener.counts().frames, 3u);
}

}  // namespace
}  // namespace deltamap::drivers::lms200
