// SPDX-License-Identifier: Apache-2.0
// What a part of the session is tested with alone: a receiver that is fed single packets, a queue whose commands can be
// looked at, and the time.
#pragma once

#include <gtest/gtest.h>

#include <vector>

#include "drivers/pioneer/transmitter.hpp"

namespace deltamap::drivers::pioneer {

class PartTest : public testing::Test {
 protected:
  [[nodiscard]] Transmitter line() { return {receiver, commands, now, out}; }

  /// The receiver takes a whole frame; answers its packet.
  Packet take(const std::vector<std::uint8_t>& frame) {
    const std::vector<Packet> packets = receiver.decode(frame, now);
    EXPECT_EQ(packets.size(), 1u);
    (void)receiver.take(packets.at(0));
    return packets.at(0);
  }

  /// Everything that waits goes out, and time passes for it.
  std::vector<Command> sent() {
    std::vector<Command> sent;
    while (const std::optional<Timestamp> due = commands.next_due()) {
      now = std::max(now, *due);
      sent.push_back(commands.take_due(now, receiver.baud()).value());
    }
    return sent;
  }

  static inline const std::vector<Command> kStop{
      {CommandNumber::kEstop, {}}, {CommandNumber::kVel, 0}, {CommandNumber::kRvel, 0}};

  Receiver receiver{PioneerParams{}};
  CommandQueue commands;
  Timestamp now = timestamp_from_ns(1'700'000'000'000'000'000);
  SessionOutput out;
};

}  // namespace deltamap::drivers::pioneer
