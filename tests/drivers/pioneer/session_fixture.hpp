// SPDX-License-Identifier: Apache-2.0
// A session that talks to a fake controller in virtual time; whatever a test does, it watches over what goes out before
// SYNC0.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <functional>
#include <vector>

#include "drivers/pioneer/session.hpp"
#include "tests/drivers/pioneer/fake_robot.hpp"
#include "tests/support/bytes/hex.hpp"

namespace deltamap::drivers::pioneer {

using tests::bytes_from_hex;

inline const auto kSync0Frame = bytes_from_hex("fafb03000000");
inline const std::vector<std::vector<std::uint8_t>> kQuiet{bytes_from_hex("fafb03370037"),
                                                           encoded_command({CommandNumber::kVel, 0}),
                                                           encoded_command({CommandNumber::kRvel, 0})};
inline const auto kCloseFrame = bytes_from_hex("fafb03020002");  // SYNC2 has the same bytes

/// What Conversation needs to know about the session.
struct TestedSession : PioneerSession {
  using PioneerSession::PioneerSession;
  using Messages = std::vector<Odometry>;
  static const Messages& messages_of(const PioneerOutput& out) { return out.odometry; }
};

class PioneerSessionTest : public testing::Test {
 protected:
  /// Whatever a test does: until the robot is connected, each SYNC0 (which is a PULSE to a robot that was left
  /// connected) comes right after ESTOP, VEL 0 and RVEL 0 at the same speed.
  void TearDown() override {
    std::size_t checked = 0;
    for (const Search& search : searches_) {
      for (std::size_t i = search.begin; i < search.end; ++i) {
        if (line.written[i].bytes != kSync0Frame) continue;
        ++checked;
        ASSERT_GE(i, search.begin + kQuiet.size());
        for (std::size_t k = 0; k < kQuiet.size(); ++k) {
          const tests::WrittenBytes& before = line.written[i - kQuiet.size() + k];
          EXPECT_EQ(before.bytes, kQuiet[k]) << "before SYNC0 number " << checked;
          EXPECT_EQ(before.baud, line.written[i].baud);
        }
      }
    }
    EXPECT_GT(checked, 0u) << "every test connects or tries to";
  }

  bool connect(double at_most_s = 30.0) {
    const std::size_t begin = line.written.size();
    line.start();
    const bool connected = line.run_until([&] { return session.is_connected(); }, at_most_s);
    searches_.push_back({begin, line.written.size()});
    return connected;
  }

  [[nodiscard]] std::size_t times_obeyed(CommandNumber number) const {
    return static_cast<std::size_t>(
        std::count_if(robot.obeyed.begin(), robot.obeyed.end(), [&](const Command& c) { return c.number == number; }));
  }

  void use(const PioneerParams& params) { session = TestedSession{params, SessionMode::kLive}; }

  TestedSession session{PioneerParams{}, SessionMode::kLive};
  FakeRobot robot{9600};
  tests::Conversation<TestedSession, FakeRobot> line{session, robot};

 private:
  struct Search {
    std::size_t begin = 0;  // indices into line.written
    std::size_t end = 0;
  };
  std::vector<Search> searches_;
};

}  // namespace deltamap::drivers::pioneer
