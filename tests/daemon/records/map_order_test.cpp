// SPDX-License-Identifier: Apache-2.0
// An operator's order for the map: in the recording, and in the map step.
#include "daemon/records/map_order.hpp"

#include <gtest/gtest.h>

#include "core/random.hpp"
#include "daemon/records/journal.hpp"
#include "daemon/steps/map_step.hpp"

namespace deltamap::daemon {
namespace {

constexpr std::size_t kLongestNote = 65'535;  // a pcapng option

SetCells order_for(int width, int height, std::vector<CellChange> changes) {
  MapOrder order;
  order.kind = MapOrder::Kind::kUndo;
  order.revision = 7;
  order.scan = 120;
  order.scan_time = timestamp_from_ns(1'700'000'000'123'456'789);
  return {order, width, height, std::move(changes)};
}

/// Cells that no packing makes small.
SetCells large_order() {
  Random random{3};
  std::vector<CellChange> changes;
  for (int row = 0; row < 300; ++row) {
    for (int column = 0; column < 400; column += 2) {
      const auto before = static_cast<CellState>(random.index_below(3));
      changes.push_back({{column, row}, before, static_cast<CellState>(random.index_below(3))});
    }
  }
  return order_for(400, 300, std::move(changes));
}

TEST(MapOrder, OfAThingSurvivesTheRecordingToo) {
  SetCells set = order_for(10, 10, {{{1, 2}, CellState::kFree, CellState::kOccupied}});
  set.order.kind = MapOrder::Kind::kUndoThing;
  set.order.thing = 12;
  Journal journal;
  for (const std::string& note : notes_of(set)) journal.read(note);
  ASSERT_EQ(journal.commands().size(), 1u);
  EXPECT_EQ(journal.commands()[0].set->order.kind, MapOrder::Kind::kUndoThing);
  EXPECT_EQ(journal.commands()[0].set->order.thing, 12u);
  EXPECT_EQ(reason_of(journal.commands()[0].set->order), "undo of thing 12 by an operator");
}

TEST(MapOrder, SurvivesTheRecordingWhateverItsSize) {
  const SetCells set = large_order();
  const std::vector<std::string> notes = notes_of(set);
  ASSERT_GT(notes.size(), 1u);
  Journal journal;
  for (const std::string& note : notes) {
    EXPECT_LE(note.size(), kLongestNote);
    EXPECT_TRUE(journal.commands().empty());
    journal.read(note);
    journal.read("scan 3 dropped");
  }
  ASSERT_EQ(journal.commands().size(), 1u);
  const Decision& command = journal.commands().front();
  EXPECT_EQ(command.kind, Decision::Kind::kMapSet);
  EXPECT_EQ(command.scan, 120u);
  EXPECT_EQ(command.scan_time, set.order.scan_time);
  EXPECT_EQ(command.set->order.kind, MapOrder::Kind::kUndo);
  EXPECT_EQ(command.set->order.revision, 7u);
  EXPECT_EQ(command.set->width, 400);
  EXPECT_EQ(command.set->height, 300);
  EXPECT_EQ(command.set->changes, set.changes);
}

TEST(MapOrder, StandsAmongTheOtherCommandsWhereItWasGiven) {
  Journal journal;
  journal.read("mapping paused before scan 100 at 1");
  journal.read("mapping resumed before scan 130 at 2");  // noted before the map thread has come so far
  for (const std::string& note : notes_of(order_for(10, 10, {{{1, 2}, CellState::kOccupied, CellState::kFree}}))) {
    journal.read(note);
  }
  ASSERT_EQ(journal.commands().size(), 3u);
  EXPECT_EQ(journal.commands()[1].kind, Decision::Kind::kMapSet);
}

TEST(MapOrder, OfADamagedNoteNothingIsTaken) {
  const SetCells set = order_for(10, 10, {{{1, 2}, CellState::kOccupied, CellState::kFree}});
  const std::string note = notes_of(set).front();
  std::size_t harmless = 0;  // base64 ends with bits and signs that mean nothing
  const auto expect_nothing_of = [&](const std::string& damaged) {
    const auto read = SetCellsReader{}.read(damaged);
    if (read == nullptr) return;
    ++harmless;
    EXPECT_EQ(read->changes, set.changes) << damaged;
  };
  for (std::size_t i = 0; i < note.size(); ++i) {
    std::string damaged = note;
    damaged[i] = damaged[i] == 'A' ? 'B' : 'A';
    expect_nothing_of(damaged);
    expect_nothing_of(note.substr(0, i));
  }
  EXPECT_LT(harmless, 6u);
  SetCellsReader reader;
  const std::vector<std::string> notes = notes_of(large_order());
  for (std::size_t i = 1; i < notes.size(); ++i) EXPECT_EQ(reader.read(notes[i]), nullptr) << "the first is missing";
}

class MapStepOrder : public testing::Test {
 protected:
  MapStepOrder() : step{Settings{}, {std::make_shared<const OccupancyGrid>(room), 4}} {}

  OccupancyGrid room{{40, 30, 0.05, {0.0, 0.0}}, CellState::kFree};
  MapStep step;
};

TEST_F(MapStepOrder, SetsTheCellsWhateverTheyAre) {
  const MapStep::Result result =
      step.obey(order_for(40, 30,
                          {{{1, 1}, CellState::kUnknown, CellState::kOccupied},  // it is free here
                           {{2, 1}, CellState::kOccupied, CellState::kFree},     // it is so already
                           {{3, 1}, CellState::kFree, CellState::kUnknown}}));
  ASSERT_TRUE(result.revision);
  EXPECT_EQ(result.revision->number, 5u);
  EXPECT_EQ(result.revision->changes, (std::vector<CellChange>{{{1, 1}, CellState::kFree, CellState::kOccupied},
                                                               {{3, 1}, CellState::kFree, CellState::kUnknown}}));
  EXPECT_FALSE(result.revision->field_patch.box.empty()) << "the localizer takes it like any revision";
  EXPECT_EQ(result.note.added, 1u);
  EXPECT_EQ(result.note.forgotten, 1u);
  EXPECT_EQ(result.note.reason, "undo of 7 by an operator");
  EXPECT_NE(json_line(result.note).find("\"operator\":true"), std::string::npos);
}

TEST_F(MapStepOrder, IsNotedWhereItChangesNothing) {
  const MapStep::Result again = step.obey(order_for(40, 30, {{{2, 1}, CellState::kOccupied, CellState::kFree}}));
  EXPECT_FALSE(again.revision);
  EXPECT_EQ(again.note.reason, "undo of 7 by an operator: it is so already");
  const MapStep::Result other = step.obey(order_for(30, 40, {{{2, 1}, CellState::kFree, CellState::kOccupied}}));
  EXPECT_FALSE(other.revision);
  EXPECT_EQ(other.note.reason, "undo of 7 by an operator: another map");
  EXPECT_EQ(*step.map(), room);
  EXPECT_EQ(step.revision(), 4u);
}

}  // namespace
}  // namespace deltamap::daemon
