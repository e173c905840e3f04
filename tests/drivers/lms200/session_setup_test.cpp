// SPDX-License-Identifier: Apache-2.0
// The way to a stream, with a laser in whatever state and with whatever refusals; and the leave.
#include "core/random.hpp"
#include "tests/drivers/lms200/session_fixture.hpp"
#include "tests/support/bytes/damage.hpp"

namespace deltamap::drivers::lms200 {
namespace {

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

TEST_F(Lms200SessionTest, PointsTheBeamsOfAnLmsFastWhichRefusesOtherVariants) {
  laser.refuses_variant = true;
  laser.variant = {90, 50};
  ASSERT_TRUE(stream());
  EXPECT_EQ(line.messages.back().beams.size(), 181u);
  EXPECT_NEAR(degrees(line.messages.back().first_bearing_rad), -45.0, 1e-9);
  EXPECT_TRUE(line.has_logged("refuses variant=180/0.5: keeps 90/0.5"));
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

TEST_F(Lms200SessionTest, StopsTheStreamWhenItTakesItsLeave) {
  ASSERT_TRUE(stream());
  line.carry_out(session.close(line.now));
  EXPECT_FALSE(line.wake_at);
  EXPECT_FALSE(laser.is_streaming);
}

TEST(Lms200SessionParams, AreRefusedWithAReason) {
  EXPECT_THROW((Lms200Session{{.variant = {180, 25}}, SessionMode::kLive}), std::invalid_argument);
  EXPECT_THROW((Lms200Session{{.measuring_mode = std::uint8_t{0x3F}}, SessionMode::kLive}), std::invalid_argument);
  EXPECT_THROW((Lms200Session{{.baud = 115200}, SessionMode::kLive}), std::invalid_argument);
}

}  // namespace
}  // namespace deltamap::drivers::lms200
