// SPDX-License-Identifier: Apache-2.0
#include "drivers/lms200/session.hpp"

#include <gtest/gtest.h>

#include "core/random.hpp"
#include "tests/drivers/lms200/fake_laser.hpp"
#include "tests/support/bytes/damage.hpp"
#include "tests/support/bytes/hex.hpp"

namespace deltamap::drivers::lms200 {
namespace {

/// What Conversation needs to know about the session.
struct TestedSession : Lms200Session {
  using Lms200Session::Lms200Session;
  using Messages = std::vector<Scan>;
  static const Messages& messages_of(const Lms200Output& out) { return out.scans; }
};

class Lms200SessionTest : public testing::Test {
 protected:
  bool stream(double at_most_s = 30.0) {
    line.start();
    return line.run_until([&] { return session.is_streaming() && !line.messages.empty(); }, at_most_s);
  }

  void use(const Lms200Params& params) { session = TestedSession{params, SessionMode::kLive}; }

  [[nodiscard]] std::size_t times_heard(std::uint8_t command) const {
    return static_cast<std::size_t>(
        std::count_if(laser.heard.begin(), laser.heard.end(), [&](const Telegram& t) { return t.command == command; }));
  }

  void expect_streaming_as_wanted() {
    line.run_for(1.0);
    EXPECT_TRUE(session.is_streaming());
    EXPECT_EQ(laser.baud(), 38400u);
    EXPECT_EQ(session.baud(), 38400u);
    EXPECT_EQ(name_of(laser.variant), "180/0.5");
    EXPECT_EQ(laser.configuration.units(), Units::kMillimetre);
    ASSERT_FALSE(line.messages.empty());
    EXPECT_EQ(line.messages.back().beams.size(), 361u);
    EXPECT_FLOAT_EQ(line.messages.back().beams[100].range_m, 1.5F);
  }

  void expect_the_recording_to_tell_the_same() {
    Lms200Session listener{Lms200Params{.units = Units::kCentimetre}, SessionMode::kListenOnly};
    std::vector<Scan> heard;
    for (const tests::SentBytes& chunk : line.received) {
      const Lms200Output out = listener.on_bytes(chunk.bytes, chunk.at);
      EXPECT_TRUE(out.output.requests.empty());
      EXPECT_FALSE(out.output.wake_at);
      heard.insert(heard.end(), out.scans.begin(), out.scans.end());
    }
    ASSERT_EQ(heard.size(), line.messages.size());
    for (std::size_t i = 0; i < heard.size(); ++i) {
      EXPECT_EQ(heard[i].time, line.messages[i].time);
      EXPECT_EQ(heard[i].beams[7].range_m, line.messages[i].beams[7].range_m);
      EXPECT_EQ(heard[i].number, line.messages[i].number);
    }
  }

  TestedSession session{Lms200Params{}, SessionMode::kLive};
  FakeLaser laser{9600};
  tests::Conversation<TestedSession, FakeLaser> line{session, laser};
};

TEST_F(Lms200SessionTest, BringsALaserAsDeliveredToStreamAsWanted) {
  ASSERT_TRUE(stream());
  line.run_for(2.0);
  expect_streaming_as_wanted();
  EXPECT_EQ(laser.writes, 1);
  EXPECT_GE(line.messages.size(), 9u);
  for (std::size_t i = 0; i < line.messages.size(); ++i) EXPECT_EQ(line.messages[i].number, i);
}

TEST_F(Lms200SessionTest, FindsTheLaserAtAnyBaud) {
  for (const unsigned baud : {9600u, 19200u, 38400u, 500000u}) {
    laser = FakeLaser{baud};
    line.messages.clear();
    ASSERT_TRUE(stream()) << baud;
    expect_streaming_as_wanted();
  }
}

TEST_F(Lms200SessionTest, WritesTheConfigurationOnlyWhereItDiffers) {
  laser.configuration.set_units(Units::kMillimetre);
  ASSERT_TRUE(stream());
  EXPECT_EQ(laser.writes, 0);
  EXPECT_EQ(times_heard(command::kWriteConfiguration), 0u);
  EXPECT_GE(times_heard(command::kReadConfiguration), 1u);
}

TEST_F(Lms200SessionTest, ChangesNothingButUnitsAndModeInTheConfiguration) {
  laser.configuration.bytes[9] = 7;
  laser.configuration.bytes[20] = 99;
  Configuration expected = laser.configuration;
  expected.set_units(Units::kMillimetre);
  ASSERT_TRUE(stream());
  EXPECT_EQ(laser.configuration, expected);
}

TEST_F(Lms200SessionTest, PicksTheLongRangeModeWhereTheWantedRangeNeedsIt) {
  use({.max_range_m = 30.0});
  ASSERT_TRUE(stream());
  EXPECT_EQ(laser.configuration.measuring_mode(), 0x06);
  EXPECT_DOUBLE_EQ(line.messages.back().max_range_m, 30.0);
}

TEST_F(Lms200SessionTest, QuietensALaserThatIsStreaming) {
  for (const unsigned baud : {38400u, 500000u}) {
    laser = FakeLaser{baud};
    laser.is_streaming = true;
    line.messages.clear();
    ASSERT_TRUE(stream()) << baud;
    expect_streaming_as_wanted();
  }
}

TEST_F(Lms200SessionTest, AsksAgainWhereRequestsAreMissed) {
  for (const int missed : {1, 2}) {
    laser = FakeLaser{38400};
    laser.is_streaming = true;
    laser.requests_to_miss = missed;
    line.messages.clear();
    ASSERT_TRUE(stream()) << missed;
    expect_streaming_as_wanted();
  }
}

TEST_F(Lms200SessionTest, DoesNotNeedAcks) {
  laser = FakeLaser{38400};
  laser.loses_acks = true;
  ASSERT_TRUE(stream(5.0));
  expect_streaming_as_wanted();
}

TEST_F(Lms200SessionTest, FollowsALaserWhoseAnswerToTheBaudChangeIsLost) {
  laser.loses_baud_answer = true;
  ASSERT_TRUE(stream(60.0));
  EXPECT_EQ(session.baud(), 38400u);
}

TEST_F(Lms200SessionTest, StaysAtABaudThatTheLaserDoesNotLeave) {
  laser.refuses_baud = true;
  ASSERT_TRUE(stream());
  EXPECT_EQ(session.baud(), 9600u);
  EXPECT_TRUE(line.has_logged("refuses baud=38400"));
}

TEST_F(Lms200SessionTest, StreamsTheOldVariantWhereTheWantedOneIsRefused) {
  laser.refuses_variant = true;
  ASSERT_TRUE(stream());
  EXPECT_EQ(line.messages.back().beams.size(), 181u);
  EXPECT_TRUE(line.has_logged("refuses variant=180/0.5: keeps 180/1"));
}

TEST_F(Lms200SessionTest, ReadsRangesRightlyWhereTheConfigurationIsRefused) {
  laser.refuses_write = true;
  ASSERT_TRUE(stream(60.0));
  EXPECT_FLOAT_EQ(line.messages.back().beams[100].range_m, 15.0F) << "still centimetres";
  EXPECT_EQ(laser.writes, 0);
  EXPECT_EQ(times_heard(command::kWriteConfiguration), 2u) << "the EEPROM is not hammered";
  EXPECT_TRUE(line.has_logged("does not take its configuration"));
}

TEST_F(Lms200SessionTest, StreamsWithoutThePassword) {
  laser.refuses_password = true;
  ASSERT_TRUE(stream(60.0));
  EXPECT_EQ(times_heard(command::kWriteConfiguration), 0u);
  EXPECT_FLOAT_EQ(line.messages.back().beams[100].range_m, 15.0F);
}

TEST_F(Lms200SessionTest, WaitsForALaserThatStartsUpWithTheRobot) {
  laser.silent_until = line.now + std::chrono::seconds{35};
  laser.power_on_at = line.now + std::chrono::seconds{35};
  ASSERT_TRUE(stream(60.0));
  EXPECT_TRUE(line.has_logged("listening whether it starts up"));
  expect_streaming_as_wanted();
}

TEST_F(Lms200SessionTest, NamesTheSpeedsItTriedWhenNobodyAnswers) {
  laser.silent_until = Timestamp::max();
  EXPECT_FALSE(stream(200.0));
  ASSERT_TRUE(line.failed);
  EXPECT_EQ(*line.failed,
            "laser does not answer at 38400, 9600, 500000, 19200 baud: no bytes came: switched off, or not connected");
  EXPECT_TRUE(line.has_logged("laser does not answer; listening whether it starts up; no bytes came"));
}

TEST_F(Lms200SessionTest, TellsGarbageAndARobotOnItsPortFromSilence) {
  laser.silent_until = Timestamp::max();
  line.start();
  Random random{3};
  for (int i = 0; i < 100; ++i) {
    line.run_for(0.1);
    line.carry_out(session.on_bytes(tests::random_bytes(20, random), line.now));
  }
  EXPECT_TRUE(line.has_logged("listening whether it starts up; garbage came"));
  EXPECT_FALSE(line.has_logged("swapped"));
  const auto sip = tests::bytes_from_hex("FAFB03000000 FAFB0532010203 0635");  // a packet and the half of another
  line.carry_out(session.on_bytes(std::span{sip}.first(4), line.now));
  EXPECT_FALSE(line.has_logged("swapped"));
  line.carry_out(session.on_bytes(std::span{sip}.subspan(4), line.now));
  EXPECT_TRUE(line.has_logged("the ports are swapped: the robot speaks on the laser's port"));
  line.run_for(100.0);
  ASSERT_TRUE(line.failed);
  EXPECT_TRUE(line.failed->ends_with("baud: the ports are swapped: the robot speaks on the laser's port"));
}

TEST_F(Lms200SessionTest, SetsTheLaserUpAgainWhenItSaysThatItHasStarted) {
  use({.baud = 9600});
  ASSERT_TRUE(stream());
  line.run_for(2.0);
  laser.power_on_at = line.now;
  const std::size_t before = line.messages.size();
  line.run_for(8.0);
  EXPECT_TRUE(line.has_logged("laser has started up"));
  EXPECT_FALSE(line.failed);
  EXPECT_GT(line.messages.size(), before);
  EXPECT_EQ(name_of(laser.variant), "180/0.5") << "volatile: set again";
}

TEST_F(Lms200SessionTest, FindsALaserAgainThatHasLostPowerWithNumbersThatGoOn) {
  ASSERT_TRUE(stream());
  line.run_for(1.0);
  const std::size_t before = line.messages.size();
  laser.power_on_at = line.now;  // its message comes at 9600 and is garbage here
  ASSERT_TRUE(line.run_until([&] { return line.messages.size() > before + 1; }, 2.5));
  EXPECT_FALSE(line.failed);
  expect_streaming_as_wanted();
  EXPECT_EQ(line.messages.back().number, line.messages.size() - 1);
}

TEST_F(Lms200SessionTest, GoesOnWithAStreamThatComesAgainWithoutSettingItUp) {
  ASSERT_TRUE(stream());
  line.run_for(1.0);
  const std::size_t before = line.messages.size();
  const std::size_t starts = times_heard(command::kSetMode);
  laser.silent_until = line.now + std::chrono::seconds{4};
  line.run_for(4.0);
  EXPECT_FALSE(session.is_streaming());
  EXPECT_TRUE(line.has_logged("laser has sent no scan for 2000 ms"));
  ASSERT_TRUE(line.run_until([&] { return line.messages.size() > before + 2; }, 2.0));
  line.run_for(1.0);
  EXPECT_TRUE(line.has_logged("laser streams again silence_ms=4"));
  EXPECT_EQ(times_heard(command::kSetMode), starts);
  EXPECT_EQ(times_heard(command::kSetVariant), 1u);
  EXPECT_GE(times_heard(command::kRequestStatus), 1u) << "its status is looked at";
  EXPECT_TRUE(session.is_streaming());
}

TEST_F(Lms200SessionTest, SetsUpALaserThatStreamsOtherwiseThanAgreedAfterASilence) {
  ASSERT_TRUE(stream());
  line.run_for(1.0);
  laser.silent_until = line.now + std::chrono::seconds{4};
  laser.variant = {180, 100};
  line.run_for(6.5);
  expect_streaming_as_wanted();
}

TEST_F(Lms200SessionTest, BelievesNoScanOnANewPortBeforeTheStatusHasToldTheMode) {
  ASSERT_TRUE(stream());
  line.run_for(1.0);
  const std::size_t before = line.messages.size();
  const auto heard = times_heard(command::kRequestStatus);
  line.carry_out(session.start(line.now));  // the port was lost and is open again; the laser streams on
  ASSERT_TRUE(line.run_until([&] { return line.messages.size() > before; }, 2.0));
  EXPECT_GE(times_heard(command::kRequestStatus), heard + 1);
  EXPECT_TRUE(session.is_streaming());
}

TEST_F(Lms200SessionTest, RepeatsEveryRequestThatGetsANak) {
  constexpr double kUndisturbedS = 5.0;  // from the search at 38400 to the first scan
  for (int nth = 0; nth < 14; ++nth) {
    for (const int naks : {1, 3, 10}) {
      laser = FakeLaser{9600};
      laser.nak_from_request = nth;
      laser.naks_to_send = naks;
      session = TestedSession{Lms200Params{}, SessionMode::kLive};
      line.messages.clear();
      const Timestamp begin = line.now;
      ASSERT_TRUE(stream(20.0)) << nth;
      EXPECT_LT(seconds(line.now - begin), kUndisturbedS + 0.1 * naks) << naks << " from request " << nth;
      EXPECT_EQ(laser.writes, 1);
    }
  }
}

TEST_F(Lms200SessionTest, ComesUpThroughNoiseBetweenTelegrams) {
  Random random{17};
  line.start();
  for (int i = 0; i < 400; ++i) {
    line.run_for(0.03);
    line.carry_out(session.on_bytes(tests::random_bytes(1 + random.index_below(8), random), line.now));
  }
  EXPECT_FALSE(line.failed);
  EXPECT_GT(session.counts().garbage_bytes, 100u);
  line.run_for(2.0);
  expect_streaming_as_wanted();
}

TEST_F(Lms200SessionTest, KnowsHowOftenScansCome) {
  use({.variant = {180, 50}, .baud = 38400});
  EXPECT_NEAR(session.nominal_period_s(), 8 * 0.02664, 1e-9) << "4.69 Hz, B7";
  use({.variant = {180, 100}, .baud = 500000});
  EXPECT_NEAR(session.nominal_period_s(), 0.01332, 1e-9);
  use({.variant = {180, 100}, .baud = 9600});
  EXPECT_NEAR(session.nominal_period_s(), 30 * 0.01332, 1e-9);
}

TEST_F(Lms200SessionTest, DatesScansByTheLineAndTheMirror) {
  ASSERT_TRUE(stream());
  line.run_for(1.0);
  const Scan& scan = line.messages.back();
  const double expected_age_s = seconds(line_time(731, 38400)) + 0.02664;
  EXPECT_NEAR(seconds(scan.received - scan.time), expected_age_s, 1e-6);
}

TEST_F(Lms200SessionTest, StopsTheStreamWhenItTakesItsLeave) {
  ASSERT_TRUE(stream());
  line.carry_out(session.close(line.now));
  EXPECT_FALSE(line.wake_at);
  EXPECT_FALSE(laser.is_streaming);
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

TEST(Lms200SessionParams, AreRefusedWithAReason) {
  EXPECT_THROW((Lms200Session{{.variant = {180, 25}}, SessionMode::kLive}), std::invalid_argument);
  EXPECT_THROW((Lms200Session{{.measuring_mode = std::uint8_t{0x3F}}, SessionMode::kLive}), std::invalid_argument);
  EXPECT_THROW((Lms200Session{{.baud = 115200}, SessionMode::kLive}), std::invalid_argument);
}

}  // namespace
}  // namespace deltamap::drivers::lms200
