// SPDX-License-Identifier: Apache-2.0
// When a scan was taken, by chunks that were read in time, late, in pieces, or together; all of it in virtual time.
#include <gtest/gtest.h>

#include <span>

#include "core/random.hpp"
#include "drivers/lms200/session.hpp"
#include "drivers/lms200/status.hpp"
#include "tests/support/bytes/late_reader.hpp"

namespace deltamap::drivers::lms200 {
namespace {

using std::chrono::microseconds;
using std::chrono::milliseconds;
using Bytes = std::vector<std::uint8_t>;
using tests::LateReader;
using tests::SentBytes;

const Timestamp kFirstSent = timestamp_from_ns(1'700'000'000'000'000'000);
const Duration kTurn = duration_from_seconds(kMirrorTurnS);
constexpr Duration kRounding{1'000};  // line_time() of the parts and of the whole

/// A laser at one speed that sends as often as its line allows (protocols.md B7).
struct Line {
  unsigned baud;
  unsigned turns_between_scans;
};
constexpr Line kLines[] = {{38400, 8}, {500000, 1}};

Bytes scan_frame(unsigned values = 181) {
  Measurement measurement;
  measurement.words.assign(values, 1500);
  measurement.unit_code = 1;
  return encoded_measurement(measurement);
}

Bytes joined(const Bytes& first, const Bytes& second) {
  Bytes both = first;
  both.insert(both.end(), second.begin(), second.end());
  return both;
}

/// Listens to chunks, as a replay does.
class Listener {
 public:
  explicit Listener(unsigned baud) : session_{{.baud = baud}, SessionMode::kListenOnly} {
    DeviceStatus status;
    status.measuring_mode = 0x06;
    status.baud_code = baud_code(baud).value();
    hear(status_reply(status), kFirstSent - std::chrono::hours{2});
  }

  void hear(std::span<const std::uint8_t> bytes, Timestamp stamp) {
    const auto fresh = session_.on_bytes(bytes, stamp).scans;
    scans.insert(scans.end(), fresh.begin(), fresh.end());
  }
  void hear(const std::vector<SentBytes>& pieces) {
    for (const SentBytes& piece : pieces) hear(piece.bytes, piece.at);
  }

  std::vector<Scan> scans;

 private:
  Lms200Session session_;
};

void expect_rising(const std::vector<Scan>& scans) {
  for (std::size_t i = 1; i < scans.size(); ++i) {
    EXPECT_GT(scans[i].time, scans[i - 1].time) << i;
    EXPECT_GT(unix_seconds(scans[i].time), unix_seconds(scans[i - 1].time)) << i << ", as other programs read it";
  }
}

TEST(ScanTimes, LieBackFromTheReadThatEndedAStandstillAtTheLinesRate) {
  for (const auto& [baud, turns] : kLines) {
    constexpr int kScans = 5;
    LateReader line{baud};
    for (int i = 0; i < kScans; ++i) line.send(scan_frame(), kFirstSent + i * turns * kTurn);
    Listener laser{baud};
    const Timestamp read_at = kFirstSent + kScans * turns * kTurn + milliseconds{300};
    laser.hear(line.read(read_at));
    ASSERT_EQ(laser.scans.size(), 5u);
    for (int i = 0; i < kScans; ++i) {
      const auto bytes_since_stx = (kScans - static_cast<std::size_t>(i)) * scan_frame().size() - 1;
      EXPECT_EQ(laser.scans[static_cast<std::size_t>(i)].time, read_at - line_time(bytes_since_stx, baud) - kTurn)
          << i << " at " << baud;
    }
  }
}

TEST(ScanTimes, FollowTheFirstBytesOfATelegramThatWasReadWithALongPauseInside) {
  for (const auto& [baud, turns] : kLines) {
    const Bytes frame = scan_frame();
    Listener laser{baud};
    laser.hear(std::span{frame}.first(100), kFirstSent);
    laser.hear(std::span{frame}.subspan(100), kFirstSent + milliseconds{200});
    laser.hear(frame, kFirstSent + milliseconds{400});
    ASSERT_EQ(laser.scans.size(), 2u);
    EXPECT_EQ(laser.scans[0].time, kFirstSent - line_time(99, baud) - kTurn);
    EXPECT_EQ(laser.scans[1].time, kFirstSent + milliseconds{400} - line_time(frame.size() - 1, baud) - kTurn);
  }
}

TEST(ScanTimes, NeverStepBackWhereWhatHadWaitedIsReadInPieces) {
  for (const auto& [baud, turns] : kLines) {
    for (const std::size_t piece : {std::size_t{62}, std::size_t{512}, std::size_t{900}, std::size_t{4096}}) {
      LateReader line{baud};
      for (int i = 0; i < 40; ++i) line.send(scan_frame(), kFirstSent + i * turns * kTurn);
      Listener laser{baud};
      laser.hear(line.read(kFirstSent + 10 * turns * kTurn - microseconds{1}));  // in time so far
      laser.hear(line.read(kFirstSent + 41 * turns * kTurn, piece));
      SCOPED_TRACE(std::to_string(baud) + " in pieces of " + std::to_string(piece));
      EXPECT_EQ(laser.scans.size(), 40u);
      expect_rising(laser.scans);
      for (const Scan& scan : laser.scans) EXPECT_LE(scan.time + kTurn, scan.received);
    }
  }
}

TEST(ScanTimes, NeverStepBackWhereTheNextScanTookLonger) {
  for (const auto& [baud, turns] : kLines) {
    Listener laser{baud};
    laser.hear(joined(scan_frame(101), scan_frame(401)),
               kFirstSent);  // 100 degrees in steps of 1, then of 0.25: four turns
    ASSERT_EQ(laser.scans.size(), 2u);
    expect_rising(laser.scans);
  }
}

TEST(ScanTimes, RiseAndAreNeverTooEarlyHoweverLateTheReaderIs) {
  Random random{54};
  for (int round = 0; round < 200; ++round) {
    const Line& laser_line = kLines[round % 2];
    LateReader line{laser_line.baud};
    std::vector<Timestamp> taken;
    for (int i = 0; i < 60; ++i) {
      taken.push_back(line.send(scan_frame(), kFirstSent + i * laser_line.turns_between_scans * kTurn) - kTurn);
    }
    const Timestamp end = taken.back() + std::chrono::seconds{1};
    Listener laser{laser_line.baud};
    for (Timestamp now = kFirstSent; now < end;) {
      const bool stands_still = random.uniform() < 0.02;
      now += microseconds{1 + random.index_below(stands_still ? 200'000 : 5'000)};
      laser.hear(line.read(now, 1 + random.index_below(2'000)));
    }
    ASSERT_EQ(laser.scans.size(), taken.size()) << round;
    expect_rising(laser.scans);
    for (std::size_t i = 0; i < taken.size(); ++i) {
      ASSERT_GE(laser.scans[i].time, taken[i] - kRounding) << round << ", " << i;
      ASSERT_LE(laser.scans[i].time + kTurn, laser.scans[i].received) << round << ", " << i;
    }
  }
}

TEST(ScanTimes, AreRightToTheJitterOfAReaderThatIsNeverMuchTooLate) {
  constexpr std::uint32_t kJitter_us = 3'000;
  Random random{7};
  for (const auto& [baud, turns] : kLines) {
    LateReader line{baud};
    std::vector<Timestamp> taken;
    for (int i = 0; i < 300; ++i) taken.push_back(line.send(scan_frame(), kFirstSent + i * turns * kTurn) - kTurn);
    Listener laser{baud};
    for (Timestamp now = kFirstSent; now < taken.back() + std::chrono::seconds{1};) {
      now += microseconds{1 + random.index_below(kJitter_us)};
      laser.hear(line.read(now));
    }
    ASSERT_EQ(laser.scans.size(), taken.size());
    for (std::size_t i = 0; i < taken.size(); ++i) {
      EXPECT_GE(laser.scans[i].time, taken[i] - kRounding);
      EXPECT_LE(laser.scans[i].time, taken[i] + microseconds{kJitter_us});
    }
  }
}

TEST(ScanTimes, FollowTheClockOfARecordingThatWasSetBack) {
  constexpr unsigned kBaud = 38400;
  const Bytes frame = scan_frame();
  Listener laser{kBaud};
  for (const Timestamp stamp :
       {kFirstSent, kFirstSent - std::chrono::hours{1}, kFirstSent - std::chrono::minutes{59}}) {
    laser.hear(frame, stamp);
    EXPECT_EQ(laser.scans.back().time, stamp - line_time(frame.size() - 1, kBaud) - kTurn);
  }
  EXPECT_EQ(laser.scans.size(), 3u);
}

}  // namespace
}  // namespace deltamap::drivers::lms200
