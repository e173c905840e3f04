// SPDX-License-Identifier: Apache-2.0
// What can be had of a store of which a disk has damaged some bytes: every revision, where they lie twice; else what
// follows from its neighbours, and the rest by number.
#include "mapping/store/store_recovery.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <numeric>
#include <string>
#include <vector>

#include "core/random.hpp"
#include "mapping/store/store_error.hpp"
#include "tests/mapping/store/written_store.hpp"
#include "tests/support/files/text_file.hpp"

namespace deltamap::mapping::store {
namespace {

namespace fs = std::filesystem;

using test::content_of;
using test::first_map;
using Numbers = std::vector<std::uint32_t>;

class StoreRecovery : public StoreFile {
 protected:
  /// M_0 to M_last, of which every 64th is whole, with a refusal and a name in between.
  void write(std::uint32_t last) {
    MapStore store{file, first_map()};
    maps = fill(store, last / 2);
    store.append_refusal(timestamp_from_ns(7), {2, 0.4, "low acceptance"});
    store.set_name(last / 3, "before the move");
    while (store.newest() < last) {
      const MapRevision revision = test::revision_after(maps.back(), store.newest() + 1);
      store.append(revision, {.cause = "evidence", .provisional = Numbers{revision.number}});
      maps.push_back(*revision.map);
    }
  }

  /// What can be had, in a store of its own.
  Recovery recovered() {
    const fs::path to = folder.path() / "recovered.sqlite";
    fs::remove(to);
    return recover(file, first_map(), to);
  }
  [[nodiscard]] MapStore store() const { return MapStore{folder.path() / "recovered.sqlite", first_map()}; }

  void expect_whole(const std::string& what) const {
    const MapStore found = store();
    ASSERT_EQ(found.newest() + 1, maps.size()) << what;
    for (std::uint32_t number = 0; number < maps.size(); ++number) {
      ASSERT_EQ(found.grid(number), maps[number]) << what << ", revision " << number;
    }
    const auto history = found.history();
    ASSERT_EQ(history.size(), maps.size() + 1) << what;
    EXPECT_EQ(history[(maps.size() - 1) / 3].name, "before the move") << what;
    EXPECT_EQ(history[(maps.size() - 1) / 2 + 1].note.cause, "low acceptance") << what;
    EXPECT_EQ(found.provisional(), Numbers{found.newest()}) << what;
  }

  void damage(const std::string& table, std::uint32_t number) const {
    run_sql(file, "UPDATE " + table + " SET changes = x'FFFFFFFF' WHERE number = " + std::to_string(number));
  }

  std::vector<OccupancyGrid> maps;
};

TEST_F(StoreRecovery, OfASoundStoreIsTheSameAndLeavesItAsItIs) {
  write(100);
  const std::string before = content_of(file);
  const Recovery recovery = recovered();
  EXPECT_EQ(recovery.words(), "100 revisions recovered");
  expect_whole("nothing is damaged");
  EXPECT_EQ(content_of(file), before);
}

/// Either nothing that counts is hit, and the store opens, or it does not open, and all of it is recovered.
TEST_F(StoreRecovery, IsEveryRevisionWhereverOneByteIsFlipped) {
  write(100);
  const std::string sound = content_of(file);
  Random random{1};
  const auto below = [&](std::size_t end) { return random.index_below(static_cast<std::uint32_t>(end)); };
  std::vector<std::size_t> places(100);  // of the first page, which says what all others are
  std::iota(places.begin(), places.end(), 0);
  for (std::size_t page = 0; page < sound.size(); page += 4096) {
    for (int i = 0; i < 8; ++i) places.push_back(page + below(16));  // of its head
    for (int i = 0; i < 12; ++i) places.push_back(page + below(4096));
  }
  std::size_t recoveries = 0;
  for (const std::size_t place : places) {
    std::string damaged = sound;
    damaged[place] = static_cast<char>(damaged[place] ^ static_cast<char>(1 + below(255)));
    (void)folder.write("store.sqlite", damaged);
    for (const char* part : {"-wal", "-shm"}) fs::remove(file.string() + part);
    try {
      const MapStore opened{file, first_map()};
      for (std::uint32_t number = 0; number < maps.size(); ++number) {
        ASSERT_EQ(opened.grid(number), maps[number]) << place << ", revision " << number;
      }
    } catch (const StoreError& error) {
      ASSERT_NE(error.kind, StoreError::Kind::kOther) << place << ": " << error.what();
      const Recovery recovery = recovered();
      ASSERT_EQ(recovery.words(), "100 revisions recovered") << place << ": " << error.what();
      expect_whole(std::to_string(place));
      ++recoveries;
    }
    if (HasFatalFailure()) return;
  }
  EXPECT_GT(recoveries, places.size() / 2);
}

TEST_F(StoreRecovery, IsEveryRevisionWhereAPageIsGone) {
  write(100);
  const std::string sound = content_of(file);
  for (std::size_t page = 0; page < sound.size(); page += 4096) {
    std::string damaged = sound;
    damaged.replace(page, 4096, 4096, '\x5A');
    (void)folder.write("store.sqlite", damaged);
    ASSERT_EQ(recovered().words(), "100 revisions recovered") << page;
    expect_whole(std::to_string(page));
    if (HasFatalFailure()) return;
  }
}

TEST_F(StoreRecovery, KeepsARevisionWithANameThroughWhateverIsThinnedOutLater) {
  write(100);
  for (const bool has_lost_its_grid : {false, true}) {
    if (has_lost_its_grid) damage("revision", 33);  // what is left of it is its copy, which has a name and no grid
    EXPECT_EQ(recovered().words(), "100 revisions recovered");
    MapStore found = store();
    while (found.thin_out({.revisions = 5}, timestamp_from_ns(1'000'000'000))) continue;
    const auto history = found.history();
    EXPECT_LT(history.size(), 60u) << "others are thinned out";
    EXPECT_TRUE(std::any_of(history.begin(), history.end(), [](const StoredRevision& one) {
      return one.number == 33 && one.name == "before the move";
    })) << has_lost_its_grid;
    EXPECT_EQ(found.grid(33), maps[33]);
  }
}

TEST_F(StoreRecovery, NoRevisionIsBothComputedAndLost) {
  write(100);
  for (const char* table : {"revision", "revision_copy"}) {
    for (const std::uint32_t number : {30U, 31U}) damage(table, number);
  }
  EXPECT_EQ(recovered().words(),
            "99 revisions recovered, of these computed from their neighbours: 31; lost for good: 30");
}

TEST_F(StoreRecovery, WhatIsKnownToHaveBeenWrittenBehindTheNewestIsLost) {
  Recovery recovery{.revisions = 37, .newest = 37, .known = 37};
  EXPECT_EQ(recovery.words(), "37 revisions recovered");
  recovery.known = 103;
  EXPECT_EQ(recovery.words(), "37 revisions recovered; lost for good: 38 to 103");
  recovery.lost = {5, 38, 39};
  EXPECT_EQ(recovery.words(), "37 revisions recovered; lost for good: 5, 38 to 103");
  recovery.known = 39;
  EXPECT_EQ(recovery.words(), "37 revisions recovered; lost for good: 5, 38 to 39");
  recovery.known = 0xFFFFFFFF;
  EXPECT_EQ(recovery.words(), "37 revisions recovered; lost for good: 5, 38 to 4294967295");
}

TEST_F(StoreRecovery, FollowsFromTheNeighboursWhereBothRowsAreDamaged) {
  write(100);
  for (const char* table : {"revision", "revision_copy"}) damage(table, 30);
  EXPECT_EQ(recovered().words(), "100 revisions recovered, of these computed from their neighbours: 30");
  expect_whole("30");
  for (const char* table : {"revision", "revision_copy"})
    run_sql(file, "DELETE FROM " + std::string(table) + " WHERE number = 40");
  EXPECT_EQ(recovered().words(), "100 revisions recovered, of these computed from their neighbours: 30, 40") << "both";
}

// --- of files that older versions have written, where every row lies there once ---

TEST_F(StoreRecovery, OfAnOlderFileFollowsFromTheWholeMapBehindTheDamage) {
  write(100);
  make_older(file, 2);
  damage("revision", 30);
  EXPECT_EQ(recovered().words(), "100 revisions recovered, of these computed from their neighbours: 30");
  const MapStore found = store();
  for (std::uint32_t number = 0; number <= 100; ++number) EXPECT_EQ(found.grid(number), maps[number]) << number;
}

TEST_F(StoreRecovery, OfAnOlderFileFollowsFromTheCellsThatLaterStepsTellOf) {
  maps.push_back(first_map());
  const Numbers columns{1, 2, 3, 2, 4, 5};  // revision 4 changes again what 2 has changed
  {
    MapStore store{file, first_map()};
    for (const std::uint32_t column : columns) {
      MapRevision revision;
      revision.number = store.newest() + 1;
      const Cell cell{static_cast<int>(column), 3};
      const CellState before = maps.back()[cell];
      revision.changes = {{cell, before, before == CellState::kFree ? CellState::kOccupied : CellState::kFree}};
      maps.push_back(patched(maps.back(), revision.changes));
      revision.map = std::make_shared<const OccupancyGrid>(maps.back());
      store.append(revision, {.cause = "evidence"});
    }
  }
  make_older(file, 2);
  const std::string sound = content_of(file);
  damage("revision", 2);
  EXPECT_EQ(recovered().words(), "6 revisions recovered, of these computed from their neighbours: 2");
  for (std::uint32_t number = 0; number <= 6; ++number) EXPECT_EQ(store().grid(number), maps[number]) << number;

  (void)folder.write("store.sqlite", sound);
  damage("revision", 3);
  EXPECT_EQ(recovered().words(),
            "5 revisions recovered; lost for good: 3 (later maps are without what these alone have changed)");
  const MapStore without = store();
  EXPECT_EQ(without.grid(2), maps[2]);
  for (std::uint32_t number = 4; number <= 6; ++number) {
    EXPECT_EQ(changes_between(without.grid(number), maps[number]),
              (std::vector<CellChange>{{{3, 3}, CellState::kFree, CellState::kOccupied}}))
        << number;
  }
  EXPECT_EQ(without.history().back().note.cause, "evidence");
}

TEST_F(StoreRecovery, TellsByNumberWhatIsLost) {
  write(20);
  make_older(file, 2);
  for (const std::uint32_t number : {5u, 6u, 7u, 20u}) damage("revision", number);
  const std::string words = recovered().words();
  EXPECT_NE(words.find("lost for good: 5"), std::string::npos) << words;
  EXPECT_NE(words.find(", 20"), std::string::npos) << words;
  EXPECT_EQ(store().newest(), 19u);
  EXPECT_EQ(store().grid(4), maps[4]);
}

// --- several histories, and none ---

TEST_F(StoreRecovery, IsOfEveryFirstMapInTheFile) {
  OccupancyGrid other = first_map();
  other.set({3, 3}, CellState::kOccupied);
  write(70);
  {
    MapStore second{file, other};
    second.append(test::revision_after(other, 1), {.cause = "evidence"});
  }
  damage("revision", 30);
  EXPECT_EQ(recovered().words(), "70 revisions recovered");
  expect_whole("both");
  const MapStore second{folder.path() / "recovered.sqlite", other};
  EXPECT_EQ(second.newest(), 1u);
  EXPECT_EQ(second.grid(1), *test::revision_after(other, 1).map);
}

TEST_F(StoreRecovery, NeedsNoFirstMapInTheFile) {
  write(10);
  for (const char* table : {"revision", "revision_copy"})
    run_sql(file, "DELETE FROM " + std::string(table) + " WHERE number = 0");
  EXPECT_EQ(recovered().words(), "10 revisions recovered");
  EXPECT_EQ(store().grid(10), maps[10]);
}

TEST_F(StoreRecovery, IsNothingOfAFileThatIsNoStore) {
  const std::string nothing = "nothing of this first map's history can be recovered: begins with the first map";
  (void)folder.write("store.sqlite", std::string(10'000, 'x'));
  EXPECT_EQ(recovered().words(), nothing);
  fs::remove(file);
  run_sql(file, "CREATE TABLE songs (name TEXT)");
  EXPECT_EQ(recovered().words(), nothing);
  EXPECT_EQ(store().newest(), 0u);
}

}  // namespace
}  // namespace deltamap::mapping::store
