// SPDX-License-Identifier: Apache-2.0
// The way to a connection, with a robot in whatever state, at whatever speed.
#include "core/random.hpp"
#include "tests/drivers/pioneer/session_fixture.hpp"
#include "tests/support/bytes/damage.hpp"

namespace deltamap::drivers::pioneer {
namespace {

TEST_F(PioneerSessionTest, ConnectsAndDecodesOdometry) {
  ASSERT_TRUE(connect(2.0));
  line.run_for(1.0);
  EXPECT_GE(line.messages.size(), 9u);
  EXPECT_EQ(session.identity()->subtype, "p3dx-sh");
  ASSERT_TRUE(session.config());
  EXPECT_EQ(session.config()->watchdog_ms, 2000);
  EXPECT_FALSE(robot.sonar_on) << "nobody asked for sonar";
  EXPECT_EQ(robot.lost, 0) << "commands kept their distance";
}

TEST_F(PioneerSessionTest, FindsTheRobotAtAnyBaud) {
  robot = FakeRobot{57600};
  ASSERT_TRUE(connect());
  EXPECT_EQ(session.baud(), 57600u);
}

TEST_F(PioneerSessionTest, NamesTheSpeedsItTriedWhenNobodyAnswers) {
  robot.is_deaf = true;
  EXPECT_FALSE(connect(60.0));
  ASSERT_TRUE(line.failed);
  EXPECT_EQ(*line.failed,
            "robot does not answer at 9600, 38400, 115200, 19200, 57600 baud: no bytes came: switched off, or not "
            "connected");
  EXPECT_FALSE(line.wake_at);
}

TEST_F(PioneerSessionTest, FindsALaserOnItsPortInTheSecondSearch) {
  robot.is_deaf = true;
  const auto question = LineDiagnosis::question_to_a_laser();
  const auto times_asked = [&] {
    return std::count_if(line.written.begin(), line.written.end(), [&](const auto& w) { return w.bytes == question; });
  };
  EXPECT_FALSE(connect(60.0));
  EXPECT_EQ(times_asked(), 0) << "nothing foreign goes to a robot that may be about to answer";
  line.failed.reset();
  line.start();
  ASSERT_TRUE(line.run_until([&] { return times_asked() > 0; }, 5.0));
  const auto type = tests::bytes_from_hex("06 02801700ba4c4d533230303b3330313036333b5630322e313020102261");
  line.carry_out(session.on_bytes(type, line.now));
  line.run_for(60.0);
  ASSERT_TRUE(line.failed);
  EXPECT_TRUE(line.failed->ends_with("baud: the ports are swapped: the laser speaks on the robot's port"));
}

TEST_F(PioneerSessionTest, KeepsTheDistanceOfCommandsAfterTheQuestionToALaser) {
  robot.is_deaf = true;
  EXPECT_FALSE(connect(60.0));
  line.failed.reset();
  line.written.clear();
  line.start();
  line.run_for(60.0);
  ASSERT_TRUE(line.failed);
  constexpr Duration kLeastGap = std::chrono::milliseconds{5};  // A1
  const auto question = LineDiagnosis::question_to_a_laser();
  int asked = 0;
  Timestamp free_at;  // of the line
  for (const tests::WrittenBytes& written : line.written) {
    if (written.bytes.empty()) continue;  // a change of speed
    EXPECT_GE(seconds(written.at - free_at), seconds(kLeastGap)) << "at " << written.baud;
    free_at = written.at + line_time(written.bytes.size(), written.baud);
    asked += written.bytes == question ? 1 : 0;
  }
  EXPECT_GE(asked, 5);
}

TEST_F(PioneerSessionTest, ConnectsToARobotThatWakesUpWhileALaserIsAskedFor) {
  robot.is_deaf = true;
  EXPECT_FALSE(connect(60.0));
  line.failed.reset();
  robot.is_deaf = false;
  EXPECT_TRUE(connect());
}

TEST_F(PioneerSessionTest, StopsALeftOverRobotBeforeAnythingCouldMakeItResume) {
  for (const int closes_to_lose : {0, 1}) {
    robot = FakeRobot{9600};
    robot.be_left_over(300);
    robot.closes_to_lose = closes_to_lose;
    line.failed.reset();
    ASSERT_TRUE(connect()) << closes_to_lose;
    line.run_for(1.0);
    EXPECT_FALSE(robot.has_ever_moved) << closes_to_lose;
    EXPECT_TRUE(line.has_logged("still connected"));
  }
}

TEST_F(PioneerSessionTest, SendsNoCloseToARobotThatWaitsForAConnection) {
  ASSERT_TRUE(connect());
  const auto is_close = [](const tests::WrittenBytes& written) { return written.bytes == kCloseFrame; };
  EXPECT_EQ(std::count_if(line.written.begin(), line.written.end(), is_close), 1) << "SYNC2 alone";
  robot.connected = false;  // a reset
  line.run_for(1.0);
  ASSERT_TRUE(line.failed);
  EXPECT_EQ(std::count_if(line.written.begin(), line.written.end(), is_close), 1);
}

TEST_F(PioneerSessionTest, OwesNoCloseOnceASearchHasBegunInTheMiddleOfAFarewell) {
  ASSERT_TRUE(connect());
  line.run_for(0.5);
  robot.sip.left_mm_per_s = 300;  // CLOSE has to wait
  line.run_for(0.2);
  line.carry_out(session.close(line.now));
  line.run_for(0.2);
  ASSERT_TRUE(session.is_leaving());
  ASSERT_TRUE(connect());
  line.run_for(3.0);
  EXPECT_TRUE(robot.connected);
  EXPECT_TRUE(session.is_connected());
}

TEST_F(PioneerSessionTest, FindsARobotThatWasLeftAtTheFastBaudAndThenWaitsAtItsOwn) {
  use({.fast_baud = 38400});
  robot = FakeRobot{38400};
  robot.be_left_over(300);
  robot.idle_baud = 9600;
  ASSERT_TRUE(connect(2.0));
  EXPECT_EQ(robot.baud(), 9600u);
  EXPECT_FALSE(robot.has_ever_moved);
}

TEST_F(PioneerSessionTest, StartsOverWhenSyncIsAnsweredWithNonsense) {
  robot.sync1_to_garble = 1;
  ASSERT_TRUE(connect());
}

TEST_F(PioneerSessionTest, ConnectsThroughNoiseBetweenPackets) {
  Random random{19};
  robot.be_left_over(300);
  ASSERT_TRUE(connect());
  for (int i = 0; i < 300; ++i) {
    line.run_for(0.03);
    line.carry_out(session.on_bytes(tests::random_bytes(1 + random.index_below(8), random), line.now));
  }
  EXPECT_TRUE(session.is_connected());
  EXPECT_FALSE(robot.has_ever_moved);
  EXPECT_GT(session.counts().garbage_bytes, 300u);
}

TEST(PioneerSessionParams, AreRefusedWithAReason) {
  EXPECT_THROW((PioneerSession{{.model = "at"}, SessionMode::kLive}), std::invalid_argument);
  EXPECT_THROW((PioneerSession{{.baud = 4800}, SessionMode::kLive}), std::invalid_argument);
  EXPECT_THROW((PioneerSession{{.fast_baud = 1}, SessionMode::kLive}), std::invalid_argument);
}

}  // namespace
}  // namespace deltamap::drivers::pioneer
