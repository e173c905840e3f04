// SPDX-License-Identifier: Apache-2.0
// What a map store keeps where it may not keep everything: by count, by age, what has a name, and with a clock that
// jumps. Whatever remains can be restored bit for bit.
#include "mapping/store/store_retention.hpp"

#include <gtest/gtest.h>
#include <sqlite3.h>
#include <sys/wait.h>
#include <unistd.h>

#include <numeric>

#include "mapping/store/map_store.hpp"
#include "tests/support/daemon/stored_maps.hpp"
#include "tests/support/files/temporary_folder.hpp"

namespace deltamap::mapping::store {
namespace {

namespace fs = std::filesystem;

using test::complaint;
using test::first_map;

Timestamp day(double days) {
  return timestamp_from_ns(1'700'000'000'000'000'000) + duration_from_seconds(86400 * days);
}

std::vector<std::uint32_t> from_to(std::uint32_t first, std::uint32_t last) {
  std::vector<std::uint32_t> numbers(last - first + 1);
  std::iota(numbers.begin(), numbers.end(), first);
  return numbers;
}

std::vector<std::uint32_t> with(std::vector<std::uint32_t> whole, const std::vector<std::uint32_t>& others) {
  whole.insert(whole.end(), others.begin(), others.end());
  return whole;
}

class Retained : public testing::Test {
 protected:
  /// Some cells of its own for each revision.
  void append(MapStore& store, Timestamp time) {
    const std::uint32_t number = store.newest() + 1;
    MapRevision revision = test::revision_after(maps.back(), number);
    revision.time = time;
    store.append(revision, {number, 0.97, "evidence"});
    maps.push_back(*revision.map);
  }
  /// One a day.
  void fill(MapStore& store, std::uint32_t last) {
    while (store.newest() < last) append(store, day(store.newest() + 1));
  }
  int thin_out(MapStore& store, const Retention& retention, Timestamp now) {
    int steps = 0;
    while (store.thin_out(retention, now)) ++steps;
    return steps;
  }
  /// The revisions that are there, each held against what was written, also by one who opens the store anew.
  [[nodiscard]] std::vector<std::uint32_t> sound_numbers() const {
    const MapStore store{file, first_map()};
    EXPECT_EQ(store.newest() + 1, maps.size());
    std::vector<std::uint32_t> numbers;
    for (const StoredRevision& revision : store.history()) {
      if (revision.refused) continue;
      numbers.push_back(revision.number);
      EXPECT_EQ(store.grid(revision.number), maps[revision.number]) << revision.number;
    }
    return numbers;
  }
  /// Each tells what has changed since the one that is there before it.
  void expect_changes_to_lead_from_one_to_the_next() const {
    const MapStore store{file};
    const OccupancyGrid* before = nullptr;
    for (const StoredRevision& revision : store.history()) {
      const OccupancyGrid& after = maps[revision.number];
      if (before != nullptr) {
        const auto changes = changes_between(*before, after);
        EXPECT_EQ(store.changes(revision.number), changes);
        EXPECT_EQ(revision.box, bounding_box(changes));
        EXPECT_EQ(revision.occupied + revision.freed + revision.unknown, changes.size());
      }
      before = &after;
    }
  }

  test::TemporaryFolder folder;
  fs::path file = folder.path() / "store.sqlite";
  std::vector<OccupancyGrid> maps{first_map()};
};

TEST_F(Retained, IsEverythingWithoutARule) {
  MapStore store{file, first_map()};
  fill(store, 150);
  EXPECT_EQ(thin_out(store, {}, day(10'000)), 0);
  EXPECT_EQ(sound_numbers(), from_to(0, 150));
}

TEST_F(Retained, AreTheNewestByCountAndEveryWholeMap) {
  MapStore store{file, first_map()};
  fill(store, 200);
  EXPECT_EQ(thin_out(store, {.revisions = 70}, day(200)), 2) << "a stretch between two whole maps at a time";
  EXPECT_EQ(sound_numbers(), with({0, 64}, from_to(128, 200)));
  expect_changes_to_lead_from_one_to_the_next();
  const auto history = store.history();
  EXPECT_EQ(history[1].note.cause, "evidence (1 to 64 in one)");
  EXPECT_EQ(history[2].note.cause, "evidence (65 to 128 in one)");
  EXPECT_EQ(thin_out(store, {.revisions = 70}, day(200)), 0);
}

TEST_F(Retained, AreThoseThatTheWholeMapsLeadTo) {
  MapStore store{file, first_map()};
  fill(store, 130);
  EXPECT_EQ(thin_out(store, {.revisions = 67}, day(130)), 1);
  EXPECT_EQ(sound_numbers(), with({0}, from_to(64, 130)));
  EXPECT_EQ(thin_out(store, {.revisions = 4}, day(130)), 0) << "127 needs all steps from 64 on";
  EXPECT_EQ(thin_out(store, {.revisions = 3}, day(130)), 1);
  EXPECT_EQ(sound_numbers(), with({0, 64}, from_to(128, 130)));
}

TEST_F(Retained, IsTheNewestHoweverOldItIs) {
  MapStore store{file, first_map()};
  fill(store, 100);
  EXPECT_EQ(thin_out(store, {.days = 1.0}, day(10'000)), 1);
  EXPECT_EQ(sound_numbers(), with({0}, from_to(64, 100)));
  EXPECT_EQ(thin_out(store, {.revisions = 1}, day(10'000)), 0);
}

TEST_F(Retained, AreTheYoungByAge) {
  MapStore store{file, first_map()};
  fill(store, 200);
  EXPECT_EQ(thin_out(store, {.days = 71.5}, day(200)), 2) << "128 is 72 days old";
  EXPECT_EQ(sound_numbers(), with({0, 64}, from_to(128, 200)));
}

TEST_F(Retained, StaysWhereOneOfTheRulesKeepsIt) {
  MapStore store{file, first_map()};
  fill(store, 200);
  EXPECT_EQ(thin_out(store, {.revisions = 10, .days = 190.0}, day(200)), 0);
  EXPECT_EQ(thin_out(store, {.revisions = 190, .days = 10.0}, day(200)), 0);
  EXPECT_EQ(thin_out(store, {.revisions = 120, .days = 100.0}, day(200)), 1);
  EXPECT_EQ(sound_numbers(), with({0}, from_to(64, 200)));
}

TEST_F(Retained, IsWhatHasAName) {
  MapStore store{file, first_map()};
  fill(store, 200);
  store.set_name(30, "before the move");
  store.set_name(64, "whole anyway");
  EXPECT_EQ(thin_out(store, {.revisions = 5}, day(200)), 4);
  EXPECT_EQ(sound_numbers(), with({0, 30, 64, 128}, from_to(192, 200)));
  expect_changes_to_lead_from_one_to_the_next();
  const auto history = MapStore{file}.history();
  EXPECT_EQ(history[1].name, "before the move");
  EXPECT_EQ(history[2].name, "whole anyway");
  EXPECT_EQ(history[3].name, "");
  store.set_name(30, "");
  EXPECT_EQ(store.history()[1].name, "");
  EXPECT_EQ(sound_numbers(), with({0, 30, 64, 128}, from_to(192, 200)));
}

TEST_F(Retained, RefusesNamesThatAreNone) {
  MapStore store{file, first_map()};
  fill(store, 3);
  const std::string rule = file.string() + ": a name is one line of at most 80 bytes";
  EXPECT_EQ(complaint([&] { store.set_name(1, "two\nlines"); }), rule);
  EXPECT_EQ(complaint([&] { store.set_name(1, std::string(81, 'x')); }), rule);
  EXPECT_EQ(complaint([&] { store.set_name(9, "later"); }), file.string() + ": no revision 9 (newest: 3)");
  EXPECT_EQ(store.history()[1].name, "");
}

TEST_F(Retained, SaysWhereARevisionIsThatIsNotThereAnyMore) {
  MapStore store{file, first_map()};
  fill(store, 130);
  (void)thin_out(store, {.revisions = 1}, day(130));
  EXPECT_EQ(complaint([&] { (void)store.grid(70); }),
            file.string() + ": revision 70 is not in the store: revision 128 holds it and what came after it");
  EXPECT_EQ(complaint([&] { (void)store.undoing(70, maps.back()); }).find(file.string() + ": revision 70 is not"), 0u);
}

TEST_F(Retained, StaysAtWhatWasStoredWholeInBetween) {
  MapStore store{file, first_map()};
  fill(store, 20);
  OccupancyGrid later = maps.back();
  later.set({1, 1}, CellState::kOccupied);
  store.append_whole(40, day(40), later, {.cause = "evidence (21 to 40 in one)"});
  while (maps.size() < 41) maps.push_back(later);
  fill(store, 80);
  EXPECT_EQ(thin_out(store, {.revisions = 3}, day(80)), 2);
  EXPECT_EQ(sound_numbers(), with({0, 40}, from_to(64, 80)));
  expect_changes_to_lead_from_one_to_the_next();
  EXPECT_EQ(store.history()[1].note.cause, "evidence (1 to 40 in one)");
}

TEST_F(Retained, AreAllStepsOfAStretchOfWhichOneIsDamaged) {
  MapStore store{file, first_map()};
  fill(store, 70);
  sqlite3* database = nullptr;
  ASSERT_EQ(sqlite3_open(file.c_str(), &database), SQLITE_OK);
  ASSERT_EQ(sqlite3_exec(database, "UPDATE revision SET changes = x'' WHERE number = 9", nullptr, nullptr, nullptr),
            SQLITE_OK);
  sqlite3_close(database);
  EXPECT_EQ(thin_out(store, {.revisions = 2}, day(70)), 0) << "the others lead to it from both sides";
  EXPECT_EQ(MapStore::to_read(file).history().size(), 71u);
}

TEST_F(Retained, AreThoseThatAreProvisional) {
  MapStore store{file, first_map()};
  fill(store, 200);
  store.set_provisional({100, 190});
  EXPECT_EQ(thin_out(store, {.revisions = 5}, day(200)), 1);
  EXPECT_EQ(sound_numbers(), with({0}, from_to(64, 200)));
  store.set_provisional({});
  EXPECT_EQ(thin_out(store, {.revisions = 5}, day(200)), 2);
}

// --- undo ---

TEST_F(Retained, AnUndoSaysHowManyStepsTheRevisionHolds) {
  MapStore store{file, first_map()};
  fill(store, 130);
  EXPECT_EQ(store.undoing(128, maps.back()).held_before, 0U);
  (void)thin_out(store, {.revisions = 2}, day(130));
  EXPECT_EQ(sound_numbers(), with({0, 64}, from_to(128, 130)));
  EXPECT_EQ(store.undoing(128, maps.back()).held_before, 63U);
  EXPECT_EQ(store.undoing(130, maps.back()).held_before, 0U);
}

TEST_F(Retained, ACellThatAThinnedOutStepFoundAgainIsNotUndone) {
  MapStore store{file, first_map()};
  const auto write = [&](CellState state) {
    MapRevision revision;
    revision.number = store.newest() + 1;
    revision.time = day(revision.number);
    revision.changes = {{{1, 1}, maps.back()[{1, 1}], state}};
    revision.map = std::make_shared<const OccupancyGrid>(patched(maps.back(), revision.changes));
    maps.push_back(*revision.map);
    store.append(revision, {.cause = "evidence"});
  };
  fill(store, 64);
  write(CellState::kUnknown);
  write(CellState::kOccupied);
  store.set_name(66, "occupied");
  write(CellState::kFree);
  write(CellState::kOccupied);
  while (store.newest() < 130) {  // elsewhere
    MapRevision revision;
    revision.number = store.newest() + 1;
    revision.time = day(revision.number);
    const int column = static_cast<int>(revision.number % 40);
    revision.changes = {{{column, 29}, maps.back()[{column, 29}], CellState::kUnknown}};
    revision.map = std::make_shared<const OccupancyGrid>(patched(maps.back(), revision.changes));
    maps.push_back(*revision.map);
    store.append(revision, {.cause = "evidence"});
  }
  (void)thin_out(store, {.revisions = 2}, day(130));
  EXPECT_EQ(sound_numbers(), with({0, 64, 66}, from_to(128, 130)));
  EXPECT_EQ(complaint([&] { (void)store.undoing(66, maps.back()); }),
            file.string() + ": nothing of revision 66 is left to undo");
}

// --- a clock that jumps ---

TEST_F(Retained, ATimeInTheFutureIsAsOldAsTheNextCredibleOne) {
  MapStore store{file, first_map()};
  fill(store, 60);
  while (store.newest() < 70) append(store, day(30'000));  // the clock is set wrong for ten revisions
  fill(store, 200);
  EXPECT_EQ(thin_out(store, {.days = 100.5}, day(200)), 1) << "65 goes only with 128";
  EXPECT_EQ(sound_numbers(), with({0}, from_to(64, 200)));
  EXPECT_EQ(thin_out(store, {.days = 50.0}, day(200)), 1) << "the wrong times hold nothing up";
  EXPECT_EQ(sound_numbers(), with({0, 64}, from_to(128, 200)));
}

TEST_F(Retained, ATimeBeforeThatOfAnOlderOneIsAsOldAsTheNextCredibleOne) {
  MapStore store{file, first_map()};
  fill(store, 60);
  while (store.newest() < 130) append(store, day(-19'000));  // a machine without a clock battery, after months
  append(store, day(400));
  EXPECT_EQ(thin_out(store, {.days = 30.0}, day(401)), 0) << "61 to 130 may be as young as 131";
  EXPECT_EQ(thin_out(store, {.days = 30.0}, day(500)), 2) << "131 is old, and so are they";
  EXPECT_EQ(sound_numbers(), with({0, 64}, from_to(128, 131)));
}

TEST_F(Retained, NothingGoesWhereTheClockHasFallenBackBehindAll) {
  MapStore store{file, first_map()};
  fill(store, 150);
  EXPECT_EQ(thin_out(store, {.days = 1.0}, day(-19'000)), 0);
  for (int i = 0; i < 70; ++i) append(store, day(-19'000));
  EXPECT_EQ(thin_out(store, {.days = 1.0}, day(-18'999.5)), 0);
  EXPECT_EQ(sound_numbers(), from_to(0, 220));
  EXPECT_EQ(thin_out(store, {.days = 1.0}, day(-18'998.5)), 3) << "more than a day has passed by that clock too";
}

// --- crashes and other programs ---

TEST_F(Retained, AKillInTheMidstLeavesAllOrNothingOfAStretch) {
  {
    MapStore store{file, first_map()};
    fill(store, 300);
  }
  const pid_t child = fork();
  if (child == 0) {
    MapStore store{file, first_map()};
    for (int i = 0; i < 2; ++i) (void)store.thin_out({.revisions = 5}, day(300));
    _exit(0);  // no destructor, no checkpoint
  }
  int status = 0;
  waitpid(child, &status, 0);
  EXPECT_EQ(sound_numbers(), with({0, 64}, from_to(128, 300)));
  MapStore store{file, first_map()};
  EXPECT_EQ(thin_out(store, {.revisions = 5}, day(300)), 2);
  EXPECT_EQ(sound_numbers(), with({0, 64, 128, 192}, from_to(256, 300)));
}

TEST_F(Retained, ANameGivenByAnotherProgramHoldsWhileThisOneWrites) {
  MapStore store{file, first_map()};
  fill(store, 100);
  MapStore{file}.set_name(20, "kept");
  fill(store, 150);
  (void)thin_out(store, {.revisions = 1}, day(150));
  EXPECT_EQ(sound_numbers(), with({0, 20, 64}, from_to(128, 150)));
}

TEST_F(Retained, OnlyTheHistoryOfItsOwnMapIsThinnedOut) {
  OccupancyGrid other = first_map();
  other.set({3, 3}, CellState::kOccupied);
  {
    MapStore store{file, first_map()};
    fill(store, 150);
  }
  {
    MapStore store{file, other};
    EXPECT_EQ(thin_out(store, {.revisions = 1}, day(10'000)), 0);
  }
  EXPECT_EQ(sound_numbers(), from_to(0, 150));
}

}  // namespace
}  // namespace deltamap::mapping::store
