// SPDX-License-Identifier: Apache-2.0
// When the wheels were read, by chunks that came in time, late, in pieces, or together; all of it in virtual time.
#include <gtest/gtest.h>

#include "core/random.hpp"
#include "drivers/pioneer/session.hpp"
#include "tests/support/bytes/late_reader.hpp"

namespace deltamap::drivers::pioneer {
namespace {

using std::chrono::microseconds;
using std::chrono::milliseconds;
using tests::LateReader;
using tests::SentBytes;

const Timestamp kFirstSent = timestamp_from_ns(1'700'000'000'000'000'000);
constexpr Duration kCycle = milliseconds{100};
constexpr unsigned kBauds[] = {9600, 38400, 115200};

std::vector<std::uint8_t> sip_frame(int number) {
  Sip sip;
  sip.x_units = static_cast<std::uint16_t>(30 * number);
  return encoded_sip(sip);
}

class Listener {
 public:
  explicit Listener(unsigned baud) : session_{{.baud = baud}, SessionMode::kListenOnly} {}

  void hear(std::span<const std::uint8_t> bytes, Timestamp stamp) {
    const auto fresh = session_.on_bytes(bytes, stamp).odometry;
    odometry.insert(odometry.end(), fresh.begin(), fresh.end());
  }
  void hear(const std::vector<SentBytes>& pieces) {
    for (const SentBytes& piece : pieces) hear(piece.bytes, piece.at);
  }

  std::vector<Odometry> odometry;

 private:
  PioneerSession session_;
};

void expect_rising(const std::vector<Odometry>& odometry) {
  for (std::size_t i = 1; i < odometry.size(); ++i) EXPECT_GT(odometry[i].time, odometry[i - 1].time) << i;
}

TEST(OdometryTimes, LieBackFromTheReadThatEndedAStandstillAtTheControllersPace) {
  for (const unsigned baud : kBauds) {
    constexpr int kSips = 6;
    LateReader line{baud};
    for (int i = 0; i < kSips; ++i) line.send(sip_frame(i), kFirstSent + i * kCycle);
    Listener robot{baud};
    const Timestamp read_at = kFirstSent + kSips * kCycle;
    robot.hear(line.read(read_at));
    ASSERT_EQ(robot.odometry.size(), 6u);
    const Timestamp newest = read_at - line_time(sip_frame(0).size() - 1, baud);
    for (int i = 0; i < kSips; ++i) {
      EXPECT_EQ(robot.odometry[static_cast<std::size_t>(i)].time, newest - (kSips - 1 - i) * kCycle) << i;
    }
  }
}

TEST(OdometryTimes, OfTwoPacketsThatWereReadInTimeLieAsTheyCame) {
  constexpr unsigned kBaud = 38400;
  Listener robot{kBaud};
  for (int i = 0; i < 20; ++i) {
    robot.hear(sip_frame(i), kFirstSent + i * milliseconds{13});  // a recording with a packet for each scan
    EXPECT_EQ(robot.odometry.back().time,
              kFirstSent + i * milliseconds{13} - line_time(sip_frame(i).size() - 1, kBaud));
  }
}

TEST(OdometryTimes, NeverStepBackHoweverLateAndInWhateverPiecesTheReaderReads) {
  Random random{54};
  for (int round = 0; round < 200; ++round) {
    const unsigned baud = kBauds[round % 3];
    LateReader line{baud};
    std::vector<Timestamp> sent;
    for (int i = 0; i < 60; ++i) sent.push_back(line.send(sip_frame(i), kFirstSent + i * kCycle));
    Listener robot{baud};
    for (Timestamp now = kFirstSent; now < sent.back() + std::chrono::seconds{1};) {
      const bool stands_still = random.uniform() < 0.05;
      now += microseconds{1 + random.index_below(stands_still ? 900'000 : 5'000)};
      robot.hear(line.read(now, 1 + random.index_below(100)));
    }
    ASSERT_GT(robot.odometry.size(), sent.size() / 2)
        << round << ": a packet that a long standstill breaks is given up";
    expect_rising(robot.odometry);
  }
}

TEST(OdometryTimes, AreNoFasterThanTheRobotHoweverLateTheReaderIs) {
  Random random{8};
  for (int round = 0; round < 100; ++round) {
    const unsigned baud = kBauds[1 + round % 2];
    LateReader line{baud};
    std::vector<Timestamp> sent;
    for (int i = 0; i < 60; ++i) sent.push_back(line.send(sip_frame(i), kFirstSent + i * kCycle));
    Listener robot{baud};
    for (Timestamp now = kFirstSent; now < sent.back() + std::chrono::seconds{2};) {
      now += milliseconds{100 + random.index_below(900)};
      robot.hear(line.read(now));
    }
    for (std::size_t i = 3; i < robot.odometry.size(); ++i) {
      // 0.3 m/s in truth; a fifth of a second, for a reader that was late for one packet and in time for the next
      const double way_m = robot.odometry[i].odom_from_robot.x - robot.odometry[i - 3].odom_from_robot.x;
      const double time_s = seconds(robot.odometry[i].time - robot.odometry[i - 3].time);
      ASSERT_LT(way_m, 0.3 * (time_s + 0.2) + 1e-9) << round << ", " << i;
    }
  }
}

TEST(OdometryTimes, NeverStepBackWhereTheRobotTellsItsLatency) {
  Listener robot{9600};
  ConfigPacket config;
  config.kinematics_delay_ms = 250;
  robot.hear(sip_frame(0), kFirstSent);
  robot.hear(encoded_config(config), kFirstSent + milliseconds{50});
  for (int i = 1; i < 5; ++i) robot.hear(sip_frame(i), kFirstSent + i * kCycle);
  ASSERT_EQ(robot.odometry.size(), 5u);
  expect_rising(robot.odometry);
  EXPECT_EQ(robot.odometry[4].time,
            kFirstSent + 4 * kCycle - milliseconds{250} - line_time(sip_frame(4).size() - 1, 9600));
}

}  // namespace
}  // namespace deltamap::drivers::pioneer
