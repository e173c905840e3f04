// SPDX-License-Identifier: Apache-2.0
#include "daemon/steps/run_begin.hpp"

#include <gtest/gtest.h>

#include "core/random.hpp"
#include "daemon/records/journal.hpp"
#include "daemon/replay/replay_start.hpp"
#include "tests/support/daemon/stored_maps.hpp"

namespace deltamap::daemon {
namespace {

constexpr std::size_t kLongestNote = 65'535;  // a pcapng option

/// A map, a pose and a record of stability that no packing makes small.
RunBegin large_begin() {
  Random random{5};
  OccupancyGrid grid{{300, 400, 0.05, {-1.0 / 3.0, 2.5}}};
  for (int row = 0; row < 400; ++row) {
    for (int column = 0; column < 300; ++column) {
      grid.set({column, row}, static_cast<CellState>(random.index_below(3)));
    }
  }
  localization::belief::StabilityRecord stability{grid.geometry(), 4, {}};
  for (int i = 0; i < 4 * 75 * 100; ++i) stability.bytes.push_back(static_cast<std::uint8_t>(random.index_below(256)));
  RunBegin begin{0xFEDCBA9876543210u, 0xFFFFFFFFFFFFFFFFu, {}};
  begin.start.map = std::make_shared<const OccupancyGrid>(std::move(grid));
  begin.start.revision = 7;
  begin.start.provisional = {{5, {{{1, 2}, CellState::kFree, CellState::kOccupied}}},
                             {7, test::revision_after(*begin.start.map, 7, 3000).changes}};
  begin.start.remembered = Pose2{1.0 / 3.0, -2e-9, 3.0 / 7.0};
  begin.start.believed = PoseDeviation{1.0 / 9.0, 2.0 / 11.0};
  begin.start.stability = std::move(stability);
  begin.start.calibration = localization::motion::DriveCalibration{
      {1.0 / 7.0, -0.02, 1e-9, 0.1}, {0.01, 0.02, 0.03, 0.04}, {0.01, -0.01, 1.0 / 300.0}, {0.001, 0.002, 0.003}};
  return begin;
}

TEST(RunBegin, SurvivesTheRecordingBitForBitWhateverItsSize) {
  const RunBegin begin = large_begin();
  const std::vector<std::string> notes = begin_notes(begin);
  EXPECT_GT(notes.size(), 1u);
  BeginReader reader;
  reader.read("baud 38400");
  for (const std::string& note : notes) {
    EXPECT_LE(note.size(), kLongestNote);
    EXPECT_FALSE(run_of_note(note));
    EXPECT_FALSE(decision_of_note(note));
    EXPECT_FALSE(reader.begin());
    reader.read(note);
    reader.read("scan 3 dropped");
  }
  ASSERT_TRUE(reader.begin());
  EXPECT_FALSE(reader.is_incomplete());
  const RunBegin& back = *reader.begin();
  EXPECT_EQ(back.first_map, begin.first_map);
  EXPECT_EQ(back.memory, begin.memory);
  EXPECT_EQ(back.start.revision, 7u);
  EXPECT_EQ(*back.start.map, *begin.start.map);
  ASSERT_TRUE(back.start.believed);
  EXPECT_EQ(back.start.believed->position_m, begin.start.believed->position_m);
  EXPECT_EQ(back.start.believed->heading_rad, begin.start.believed->heading_rad);
  ASSERT_EQ(back.start.provisional.size(), 2u);
  for (std::size_t i = 0; i < 2; ++i) {
    EXPECT_EQ(back.start.provisional[i].number, begin.start.provisional[i].number);
    EXPECT_EQ(back.start.provisional[i].changes, begin.start.provisional[i].changes);
  }
  EXPECT_EQ(back.start.remembered, begin.start.remembered);
  ASSERT_TRUE(back.start.calibration);
  EXPECT_EQ(numbers_of(*back.start.calibration), numbers_of(*begin.start.calibration));
  EXPECT_EQ(back.start.stability->bytes, begin.start.stability->bytes);
  EXPECT_EQ(back.start.stability->geometry, begin.start.stability->geometry);
  EXPECT_EQ(back.start.stability->cells_a_tile, 4);
}

TEST(RunBegin, SaysNothingWhereARunBeginsFromItsMapAlone) {
  RunBegin begin;
  begin.start.map = std::make_shared<const OccupancyGrid>(GridGeometry{2, 2, 0.1, {0.0, 0.0}});
  EXPECT_TRUE(begin_notes(begin).empty());
}

TEST(RunBegin, HoldsNoMapWhereItIsTheFirstOne) {
  RunBegin begin;
  begin.start.remembered = Pose2{1.0, 2.0, 3.0};
  BeginReader reader;
  for (const std::string& note : begin_notes(begin)) reader.read(note);
  ASSERT_TRUE(reader.begin());
  EXPECT_EQ(reader.begin()->start.map, nullptr);
  EXPECT_FALSE(reader.begin()->start.stability);
}

TEST(RunBegin, IsIncompleteWhereANoteIsMissingOrDamaged) {
  const std::vector<std::string> notes = begin_notes(large_begin());
  for (std::size_t missing = 0; missing < notes.size(); ++missing) {
    BeginReader reader;
    for (std::size_t i = 0; i < notes.size(); ++i) {
      if (i != missing) reader.read(notes[i]);
    }
    EXPECT_TRUE(reader.is_incomplete()) << missing;
    EXPECT_FALSE(reader.begin()) << missing;
  }
  for (const std::size_t at : {20u, 30u, 300u, 5000u}) {
    std::vector<std::string> damaged = notes;
    damaged.front()[at] = damaged.front()[at] == 'x' ? 'y' : 'x';
    BeginReader reader;
    for (const std::string& note : damaged) reader.read(note);
    EXPECT_TRUE(reader.is_incomplete()) << at;
  }
}

/// A recording of a run on `begin`, as the daemon begins it with the default settings.
RecordedRun recorded_run_on(const RunBegin& begin) {
  RecordedRun recorded;
  recorded.journal.read(
      note_of(RunIdentity{settings_fingerprint(Settings{}), grid_hash(*begin.start.map), begin.memory}));
  for (const std::string& note : begin_notes(begin)) recorded.begin.read(note);
  return recorded;
}

TEST(ReplayStart, IsWhatTheRunBeganFromOnTheFirstMapAndOnItsOwn) {
  RunBegin begin = large_begin();
  const auto first = std::make_shared<const OccupancyGrid>(begin.start.map->geometry(), CellState::kFree);
  begin.first_map = grid_hash(*first);
  const RecordedRun recorded = recorded_run_on(begin);
  for (const auto& given : {first, begin.start.map}) {
    const ReplayStart on = replay_start(recorded, ReplayJob{}, given);
    EXPECT_EQ(on.journal, "obeyed");
    EXPECT_EQ(on.began,
              "what the recorded run began from: revision=7 (2 provisional), kept pose, stability, wheels and mount");
    EXPECT_EQ(*on.start.map, *begin.start.map);
    EXPECT_EQ(on.start.revision, 7u);
    EXPECT_EQ(on.start.remembered, begin.start.remembered);
  }
  ReplayJob later;
  later.from_s = 5.0;
  const ReplayStart from_later = replay_start(recorded, later, first);
  EXPECT_EQ(from_later.journal, "not obeyed: another start");
  EXPECT_FALSE(from_later.start.remembered) << "the robot has driven on";
  EXPECT_EQ(from_later.start.revision, 7u);
}

TEST(ReplayStart, OfARecordingThatDoesNotHoldWhatWasKeptIsTheMapAlone) {
  RunBegin begin = large_begin();
  RecordedRun recorded = recorded_run_on(begin);
  recorded.begin.forget();
  const ReplayStart old = replay_start(recorded, ReplayJob{}, begin.start.map);
  EXPECT_EQ(old.journal, "not obeyed: it began with a pose that was kept");
  EXPECT_EQ(old.began, "the map alone: what the recorded run had kept is not in the recording");
  recorded.begin.read(begin_notes(begin).front());
  const ReplayStart cut = replay_start(recorded, ReplayJob{}, begin.start.map);
  EXPECT_EQ(cut.began, "the map alone: what the recorded run began from is damaged");
  EXPECT_EQ(cut.start.revision, 0u);
}

}  // namespace
}  // namespace deltamap::daemon
