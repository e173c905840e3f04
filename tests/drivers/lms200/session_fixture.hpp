// SPDX-License-Identifier: Apache-2.0
// A session that talks to a fake laser in virtual time.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

#include "drivers/lms200/session.hpp"
#include "tests/drivers/lms200/fake_laser.hpp"

namespace deltamap::drivers::lms200 {

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

}  // namespace deltamap::drivers::lms200
