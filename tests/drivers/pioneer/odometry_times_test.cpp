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

TEST(OdometryTimes, LieBackFromTheReadThatEndedAStandstillAtTheLinesRate) {
  for (const unsigned baud : kBauds) {
    constexpr int kSips = 6;
    LateReader line{baud};
    for (int i = 0; i < kSips; ++i) line.send(sip_frame(i), kFirstSent + i * kCycle);
    Listener robot{baud};
    const Timestamp read_at = kFirstSent + kSips * kCycle;
    robot.hear(line.read(read_at));
    ASSERT_EQ(robot.odometry.size(), 6u);
    for (int i = 0; i < kSips; ++i) {
      const auto bytes_since_first = (kSips - static_cast<std::size_t>(i)) * sip_frame(0).size() - 1;
      EXPECT_EQ(robot.odometry[static_cast<std::size_t>(i)].time, read_at - line_time(bytes_since_first, baud)) << i;
    }
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
