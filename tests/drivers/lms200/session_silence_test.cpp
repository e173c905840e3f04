// SPDX-License-Identifier: Apache-2.0
// A laser that does not answer, has fallen silent, or has started up anew.
#include "core/random.hpp"
#include "tests/drivers/lms200/session_fixture.hpp"
#include "tests/support/bytes/damage.hpp"
#include "tests/support/bytes/hex.hpp"

namespace deltamap::drivers::lms200 {
namespace {

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

}  // namespace
}  // namespace deltamap::drivers::lms200
