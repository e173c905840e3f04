// SPDX-License-Identifier: Apache-2.0
#include "mapping/store/map_store.hpp"

#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <filesystem>
#include <utility>

#include "tests/mapping/store/written_store.hpp"
#include "tests/support/files/text_file.hpp"

namespace deltamap::mapping::store {
namespace {

namespace fs = std::filesystem;

using test::complaint;
using test::first_map;
using test::revision_after;

using Store = StoreFile;

TEST_F(Store, BeginsWithTheFirstMap) {
  const MapStore store{file, first_map()};
  EXPECT_EQ(store.newest(), 0u);
  EXPECT_EQ(store.grid(0), first_map());
}

TEST_F(Store, GivesEveryRevisionBackAfterReopening) {
  std::vector<OccupancyGrid> maps;
  {
    MapStore store{file, first_map()};
    maps = fill(store, 150);  // more than two whole grids
  }
  const MapStore store{file, first_map()};
  ASSERT_EQ(store.newest(), 150u);
  for (std::uint32_t number = 0; number <= 150; ++number) EXPECT_EQ(store.grid(number), maps[number]) << number;
}

TEST_F(Store, TellsWhatHappened) {
  MapStore store{file, first_map()};
  fill(store, 1);
  store.append_refusal(timestamp_from_ns(7), {2, 0.4, "low acceptance"});
  const auto history = store.history();
  ASSERT_EQ(history.size(), 3u);
  EXPECT_EQ(history[0].note.cause, "first map");
  EXPECT_EQ(history[1].number, 1u);
  EXPECT_EQ(history[1].note.acceptance, 0.97);
  EXPECT_EQ(history[1].occupied + history[1].freed + history[1].unknown,
            changes_between(first_map(), store.grid(1)).size());
  EXPECT_EQ(history[1].box, bounding_box(changes_between(first_map(), store.grid(1))));
  EXPECT_TRUE(history[2].refused);
  EXPECT_EQ(history[2].note.cause, "low acceptance");
  EXPECT_EQ(unix_ns(history[2].time), 7);
}

TEST_F(Store, KeepsTheHistoriesOfTwoMapsApart) {
  OccupancyGrid other = first_map();
  other.set({3, 3}, CellState::kOccupied);
  {
    MapStore store{file, first_map()};
    fill(store, 3);
  }
  EXPECT_EQ((MapStore{file, other}.newest()), 0u);
  EXPECT_EQ((MapStore{file, other}.grid(0)), other);
  EXPECT_EQ((MapStore{file}.grid(0)), other);  // the one used last
  EXPECT_EQ((MapStore{file, first_map()}.newest()), 3u);
}

TEST_F(Store, GoesBackWithoutLosingAnything) {
  MapStore store{file, first_map()};
  const auto maps = fill(store, 5);
  EXPECT_EQ(store.roll_back(2, timestamp_from_ns(1)), 6u);
  EXPECT_EQ(store.grid(6), maps[2]);
  EXPECT_EQ(store.grid(5), maps[5]);
  EXPECT_EQ(store.history().back().note.cause, "rolled back to 2");
}

/// Appends what turns these cells of the newest map into that state.
void write(MapStore& store, const std::vector<Cell>& cells, CellState state) {
  const OccupancyGrid before = store.grid(store.newest());
  OccupancyGrid after = before;
  for (const Cell cell : cells) after.set(cell, state);
  MapRevision revision;
  revision.number = store.newest() + 1;
  revision.changes = changes_between(before, after);
  revision.map = std::make_shared<const OccupancyGrid>(std::move(after));
  store.append(revision, {.cause = "evidence"});
}

TEST_F(Store, TakesADeltaBackAndKeepsWhatCameLater) {
  MapStore store{file, first_map()};
  write(store, {{1, 1}, {2, 1}, {3, 1}}, CellState::kOccupied);
  write(store, {{20, 20}}, CellState::kOccupied);
  write(store, {{3, 1}}, CellState::kUnknown);  // changed again: no longer what Δ 1 wrote
  OccupancyGrid wanted = store.grid(3);
  wanted.set({1, 1}, CellState::kFree);
  wanted.set({2, 1}, CellState::kFree);
  const MapStore::Undoing undoing = store.undoing(1, store.grid(3));
  EXPECT_EQ(undoing.changes.size(), 2u);
  EXPECT_EQ(undoing.kept, 1u);
  EXPECT_EQ(store.undo(1, timestamp_from_ns(9)), 4u);
  EXPECT_EQ(store.grid(4), wanted);
  EXPECT_EQ(store.history().back().note.cause, "undo of 1");
  EXPECT_EQ(unix_ns(store.history().back().time), 9);
  EXPECT_EQ((MapStore{file, first_map()}.grid(4)), wanted);
}

TEST_F(Store, LeavesACellThatALaterDeltaFoundAgain) {
  MapStore store{file, first_map()};
  write(store, {{1, 1}, {2, 1}}, CellState::kOccupied);
  write(store, {{1, 1}}, CellState::kFree);
  write(store, {{1, 1}}, CellState::kOccupied);  // the same state, by another Δ
  (void)store.undo(1, {});
  EXPECT_EQ((store.grid(4)[{1, 1}]), CellState::kOccupied);
  EXPECT_EQ((store.grid(4)[{2, 1}]), CellState::kFree);
}

TEST_F(Store, TakesAnUndoBack) {
  MapStore store{file, first_map()};
  write(store, {{1, 1}, {2, 1}}, CellState::kOccupied);
  (void)store.undo(1, {});
  EXPECT_EQ(store.undo(2, {}), 3u);
  EXPECT_EQ(store.grid(3), store.grid(1));
  EXPECT_EQ(store.history().back().note.cause, "undo of 2");
}

TEST_F(Store, UndoesAcrossWholeGrids) {
  MapStore store{file, first_map()};
  write(store, {{39, 29}}, CellState::kOccupied);
  for (int i = 0; i < 130; ++i) write(store, {{i % 30, i / 30}}, CellState::kOccupied);
  OccupancyGrid wanted = store.grid(131);
  wanted.set({39, 29}, CellState::kFree);
  EXPECT_EQ(store.undo(1, {}), 132u);
  EXPECT_EQ(store.grid(132), wanted);
}

TEST_F(Store, TellsInOneLineWhatCannotBeUndone) {
  MapStore store{file, first_map()};
  write(store, {{1, 1}}, CellState::kOccupied);
  (void)store.undo(1, {});
  store.append_refusal(timestamp_from_ns(7), {2, 0.4, "low acceptance"});
  const std::string at = file.string() + ": ";
  EXPECT_EQ(complaint([&] { store.undo(0, {}); }), at + "revision 0 is the first map: there is nothing to undo");
  EXPECT_EQ(complaint([&] { store.undo(3, {}); }), at + "no revision 3 (newest: 2)");
  EXPECT_EQ(complaint([&] { store.undo(1, {}); }), at + "nothing of revision 1 is left to undo");
  EXPECT_EQ(store.newest(), 2u);
}

TEST_F(Store, KeepsThePoseCovariance) {
  PoseCovariance covariance;
  covariance << 1, 2, 3, 2, 4, 5, 3, 5, 6;
  {
    MapStore store{file, first_map()};
    store.append(revision_after(first_map(), 1), {1, 0.97, "evidence", covariance});
  }
  const auto history = MapStore{file}.history();
  EXPECT_FALSE(history[0].note.covariance);
  EXPECT_EQ(history[1].note.covariance, covariance);
}

TEST_F(Store, StoresWholeWhatCouldNotBeStoredStepByStep) {
  std::vector<OccupancyGrid> maps;
  {
    MapStore store{file, first_map()};
    maps = fill(store, 3);
    for (std::uint32_t number = 4; number <= 9; ++number) maps.push_back(*revision_after(maps.back(), number).map);
    store.append_whole(9, timestamp_from_ns(9), maps[9], {.cause = "evidence (4 to 9 in one)"});
    store.append(revision_after(maps[9], 10), {});
    EXPECT_NE(complaint([&] { store.append_whole(10, {}, maps[9], {}); }).find("older"), std::string::npos);
  }
  MapStore store{file, first_map()};
  EXPECT_EQ(store.newest(), 10u);
  EXPECT_EQ(store.grid(3), maps[3]);
  EXPECT_EQ(store.grid(9), maps[9]);
  EXPECT_EQ(complaint([&] { (void)store.grid(5); }),
            file.string() + ": revision 5 is not in the store: revision 9 holds it and what came after it");
  EXPECT_EQ(store.undo(9, {}), 11u);
}

TEST_F(Store, KeepsTheNewestThousandRefusals) {
  MapStore store{file, first_map()};
  fill(store, 2);
  for (std::uint32_t phase = 0; phase < 1500; ++phase)
    store.append_refusal(timestamp_from_ns(7), {phase, 0.4, "no merge"});
  const MapStore again{file, first_map()};
  const auto history = again.history();
  ASSERT_EQ(history.size(), 3u + 1000u);
  EXPECT_EQ(history.back().note.phase, 1499u);
  EXPECT_EQ(history[3].note.phase, 500u);
}

TEST_F(Store, RefusesARevisionThatDoesNotFollow) {
  MapStore store{file, first_map()};
  EXPECT_NE(complaint([&] { store.append(revision_after(first_map(), 2), {}); }).find("does not follow"),
            std::string::npos);
  EXPECT_NE(complaint([&] { (void)store.grid(1); }).find("no revision 1"), std::string::npos);
}

TEST_F(Store, NoticesAnotherWriter) {
  MapStore store{file, first_map()};
  MapStore other{file};
  (void)other.roll_back(0, timestamp_from_ns(1));
  EXPECT_NE(complaint([&] { store.append(revision_after(first_map(), 1), {}); }).find("another program"),
            std::string::npos);
}

TEST_F(Store, SurvivesBeingKilledBetweenWrites) {
  const pid_t child = fork();
  if (child == 0) {
    MapStore store{file, first_map()};
    fill(store, 20);
    _exit(0);  // no destructor, no checkpoint: what a kill leaves behind
  }
  int status = 0;
  waitpid(child, &status, 0);
  ASSERT_TRUE(fs::exists(file.string() + "-wal"));
  EXPECT_EQ((MapStore{file, first_map()}.newest()), 20u);
}

TEST_F(Store, KeepsNothingInTheLogAlone) {
  MapStore store{file, first_map()};
  fill(store, 20);
  EXPECT_EQ(fs::file_size(file.string() + "-wal"), 0u);
  fs::copy_file(file, folder.path() / "copy.sqlite");
  EXPECT_EQ((MapStore{folder.path() / "copy.sqlite"}.newest()), 20u);
}

TEST_F(Store, ForgetsAWriteThatWasCutInTheLog) {
  const pid_t child = fork();
  if (child == 0) {
    MapStore store{file, first_map()};
    fill(store, 19);
    sqlite3* reader = nullptr;  // what is written meanwhile stays in the log
    sqlite3_open(file.c_str(), &reader);
    sqlite3_exec(reader, "BEGIN; SELECT count(*) FROM revision", nullptr, nullptr, nullptr);
    store.append(revision_after(store.grid(19), 20), {});
    _exit(0);
  }
  int status = 0;
  waitpid(child, &status, 0);
  const fs::path wal = file.string() + "-wal";
  ASSERT_GT(fs::file_size(wal), 100u);
  fs::resize_file(wal, fs::file_size(wal) - 100);
  fs::remove(file.string() + "-shm");
  MapStore store{file, first_map()};
  ASSERT_EQ(store.newest(), 19u);
  store.append(revision_after(store.grid(19), 20), {});
  EXPECT_EQ(store.newest(), 20u);
}

TEST_F(Store, IsNotOpenedWhereARowIsNotWhatWasWrittenAndStaysAsItIs) {
  {
    MapStore store{file, first_map()};
    fill(store, 10);
  }
  const std::vector<std::pair<std::string, std::string>> damages{
      {"UPDATE revision SET changes = x'FFFFFFFF' WHERE number = 8", "revision 8 is not what was written"},
      {"UPDATE revision SET time_ns = 1 WHERE number = 3", "revision 3 is not what was written"},
      {"UPDATE revision_copy SET cause = 'x' WHERE number = 5", "revision 5 is not what was written"},
      {"UPDATE map SET width = 41", "the size of a map is not what was written"},
      {"DELETE FROM revision WHERE number = 10", "a row is missing"}};
  const std::string sound = test::content_of(file);
  for (const auto& [sql, what] : damages) {
    (void)folder.write("store.sqlite", sound);
    run_sql(file, sql);
    const std::string damaged = test::content_of(file);
    EXPECT_EQ(complaint([&] { MapStore store(file, first_map()); }), file.string() + ": damaged: " + what);
    EXPECT_EQ(complaint([&] { MapStore store{file}; }), file.string() + ": damaged: " + what);
    EXPECT_EQ(test::content_of(file), damaged) << sql;
  }
}

TEST_F(Store, ReadsWhatCanBeHadOfADamagedFileIntoMemory) {
  std::vector<OccupancyGrid> maps;
  {
    MapStore store{file, first_map()};
    maps = fill(store, 10);
  }
  EXPECT_EQ(MapStore::to_read(file).damage(), "");
  run_sql(file, "UPDATE revision SET changes = x'FFFFFFFF' WHERE number = 8");
  const std::string damaged = test::content_of(file);
  const MapStore store = MapStore::to_read(file);
  EXPECT_EQ(store.damage(), file.string() + ": damaged: revision 8 is not what was written; 10 revisions recovered");
  for (std::uint32_t number = 0; number <= 10; ++number) EXPECT_EQ(store.grid(number), maps[number]) << number;
  EXPECT_EQ(test::content_of(file), damaged);
}

TEST_F(Store, KeepsWhatIsProvisional) {
  using List = std::vector<std::uint32_t>;
  {
    MapStore store{file, first_map()};
    EXPECT_EQ(store.provisional(), List{});
    store.append(revision_after(first_map(), 1), {.cause = "evidence", .provisional = List{1}});
    store.append(revision_after(store.grid(1), 2), {.cause = "evidence", .provisional = List{1, 2}});
    (void)store.roll_back(0, {});
  }
  MapStore store{file, first_map()};
  EXPECT_EQ(store.provisional(), (List{1, 2}));
  store.set_provisional({});
  EXPECT_EQ((MapStore{file, first_map()}.provisional()), List{});
}

TEST_F(Store, NamesAFileThatWasCut) {
  {
    MapStore store{file, first_map()};
    fill(store, 100);
  }
  fs::resize_file(file, fs::file_size(file) / 2);
  const std::string line = complaint([&] { MapStore store(file, first_map()); });
  EXPECT_EQ(line.find(file.string() + ": "), 0u) << line;
}

}  // namespace
}  // namespace deltamap::mapping::store
