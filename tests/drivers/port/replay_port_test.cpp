// SPDX-License-Identifier: Apache-2.0
#include "drivers/port/replay_port.hpp"

#include <gtest/gtest.h>

#include "tests/support/files/temporary_folder.hpp"

namespace deltamap::drivers::port {
namespace {

ByteRecord chunk(double at_s, Direction direction, std::uint8_t byte) {
  return {PortId::kRobot, direction, timestamp_from_ns(0) + duration_from_seconds(100.0 + at_s), {byte}, "", 0};
}

TEST(ReplayPort, GivesWhatCameInAndTheNotesAndMarksTheWindow) {
  const test::TemporaryFolder folder;
  {
    ByteLogWriter writer{folder.path() / "a.pcapng", {}};
    writer.write(chunk(0.0, Direction::kIn, 0));
    writer.write(chunk(1.0, Direction::kOut, 1));
    ByteRecord note = chunk(1.5, Direction::kIn, 0);
    note.bytes.clear();
    note.note = "revision 1 before scan 2";
    writer.write(note);
    writer.write(chunk(2.0, Direction::kIn, 2));
    writer.write(chunk(3.0, Direction::kIn, 3));
    writer.close();
  }
  ReplayPort replay{folder.path() / "a.pcapng", {.from_s = 1.2, .to_s = 2.5}};
  const auto first = replay.next();
  EXPECT_EQ(first.value().record.bytes, (std::vector<std::uint8_t>{0}));
  EXPECT_FALSE(first->in_window);
  const auto note = replay.next();
  EXPECT_EQ(note.value().record.note, "revision 1 before scan 2");
  EXPECT_TRUE(note->in_window);
  EXPECT_EQ(replay.next().value().record.bytes, (std::vector<std::uint8_t>{2}));
  EXPECT_FALSE(replay.next());
  EXPECT_FALSE(replay.next()) << "the window is over";
  EXPECT_EQ(replay.packets_before(), 2u);
  EXPECT_EQ(replay.count_packets_after(), 1u);
  EXPECT_TRUE(replay.faults().doubts.empty());
}

TEST(ReplayPort, LeavesNothingOutWhereTheClockWasSetBackBehindTheBeginning) {
  const test::TemporaryFolder folder;
  {
    ByteLogWriter writer{folder.path() / "a.pcapng", {}};
    for (const double at_s : {0.0, 1.0, -50.0, -49.0})
      writer.write(chunk(at_s, Direction::kIn, static_cast<std::uint8_t>(100.0 + at_s)));
    writer.close();
  }
  ReplayPort replay{folder.path() / "a.pcapng", {}};
  for (const std::vector<std::uint8_t>& bytes : {std::vector<std::uint8_t>{100}, {101}, {50}, {51}}) {
    const auto next = replay.next();
    EXPECT_EQ(next.value().record.bytes, bytes);
    EXPECT_TRUE(next->in_window);
  }
}

TEST(ReplayPort, CountsOnOverAClockThatWasSetBack) {
  const test::TemporaryFolder folder;
  {
    ByteLogWriter writer{folder.path() / "a.pcapng", {}};
    std::uint8_t byte = 0;
    for (const double at_s : {0.0, 2.0, -50.0, -48.5, -47.0}) writer.write(chunk(at_s, Direction::kIn, byte++));
    writer.close();
  }
  ReplayPort replay{folder.path() / "a.pcapng", {.from_s = 1.0, .to_s = 4.0}};
  for (const bool in_window : {false, true, true, true}) EXPECT_EQ(replay.next().value().in_window, in_window);
  EXPECT_FALSE(replay.next()) << "5 s after the first";
  const std::string told = testing::PrintToString(replay.faults().doubts);
  EXPECT_NE(
      told.find("a.pcapng: its clock was set back 1 time, by up to 52 s (the first 2.0 s after its first packet): "
                "times go on from there"),
      std::string::npos)
      << told;
}

}  // namespace
}  // namespace deltamap::drivers::port
