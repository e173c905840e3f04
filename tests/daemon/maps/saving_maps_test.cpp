// SPDX-License-Identifier: Apache-2.0
// What becomes of maps and their history while the disk is full, when it is not any more, and where another program has
// written to the store.
#include <sys/mount.h>
#include <unistd.h>

#include "core/files/file_lock.hpp"
#include "core/files/grid_file.hpp"
#include "daemon/maps/map_outputs.hpp"
#include "daemon/maps/store_opening.hpp"
#include "mapping/store/map_store.hpp"
#include "tests/support/daemon/saving_fixture.hpp"
#include "tests/support/files/full_disk.hpp"
#include "tests/support/files/not_root.hpp"
#include "tests/support/files/text_file.hpp"

namespace deltamap::daemon {
namespace {

namespace fs = std::filesystem;
using mapping::store::MapStore;
using test::at_s;
using test::content_of;

/// A Δ that makes one more cell occupied than the one before.
MapStep::Result result_of(std::uint32_t number) {
  auto map = std::make_shared<OccupancyGrid>(GridGeometry{40, 30, 0.1, {0.0, 0.0}}, CellState::kFree);
  for (std::uint32_t cell = 0; cell < number; ++cell) map->set({static_cast<int>(cell), 3}, CellState::kOccupied);
  MapStep::Result result;
  result.revision =
      MapRevision{.number = number,
                  .time = at_s(number),
                  .map = map,
                  .changes = {{{static_cast<int>(number) - 1, 3}, CellState::kFree, CellState::kOccupied}},
                  .field_patch = {}};
  result.note.revision = number;
  result.note.phase = number;
  return result;
}

MapStep::Result refusal_of(std::uint32_t phase) {
  MapStep::Result result;
  result.note.phase = phase;
  result.note.reason = "too few scans";
  return result;
}

class SavingMaps : public test::SavingFixture {
 protected:
  [[nodiscard]] MapOutputs::Options options() const {
    StoreToKeep to;
    to.store.emplace(store, *start.map);
    return {.out = out, .store_file = store, .store = std::move(to), .start = start, .method = "evidence"};
  }

  StartMap start{std::make_shared<OccupancyGrid>(GridGeometry{40, 30, 0.1, {0.0, 0.0}}, CellState::kFree), 0};
  fs::path out = folder.path();
  fs::path store = folder.path() / "store.sqlite";
};

TEST_F(SavingMaps, WhatWasMissedIsStoredWholeWhenThereIsRoomAgain) {
  {
    MapOutputs outputs{options(), telemetry.outputs, warn(), at_s(0)};
    for (std::uint32_t number : {1u, 2u}) outputs.save(result_of(number), at_s(number));
    {
      const test::FullDisk full;
      for (std::uint32_t number : {3u, 4u, 5u}) outputs.save(result_of(number), at_s(number));
      outputs.save(refusal_of(6), at_s(6));
      outputs.retry(at_s(7));
      for (const char* name : {"changes", "map", "history", "store"}) EXPECT_FALSE(status(name).written) << name;
    }
    EXPECT_EQ(warnings.size(), 4u) << "one an output";
    outputs.retry(at_s(30));
    for (const char* name : {"changes", "map", "history", "store"}) EXPECT_TRUE(status(name).written) << name;
    EXPECT_EQ(warnings.size(), 8u);
    outputs.save(result_of(6), at_s(31));
    outputs.close(at_s(32));
  }
  EXPECT_EQ(read_grid(out / "map.yaml"), *result_of(6).revision->map);
  const std::string changes = content_of(out / "changes.jsonl");
  EXPECT_EQ(std::count(changes.begin(), changes.end(), '\n'), 7);
  for (const fs::path& file : {store, out / "map_store.sqlite"}) {
    const MapStore kept{file, *start.map};
    EXPECT_EQ(kept.newest(), 6u);
    for (const std::uint32_t number : {1u, 2u, 5u, 6u}) {
      EXPECT_EQ(kept.grid(number), *result_of(number).revision->map) << number;
    }
    EXPECT_THROW((void)kept.grid(4), std::runtime_error);
    const auto history = kept.history();
    EXPECT_EQ(history[3].note.cause, "evidence (3 to 5 in one)");
    EXPECT_EQ(history[3].occupied, 3u);
    EXPECT_TRUE(history[4].refused);
  }
}

TEST_F(SavingMaps, GoesOnBehindWhatAnotherProgramHasWrittenIntoTheStore) {
  MapOutputs outputs{options(), telemetry.outputs, warn(), at_s(0)};
  outputs.save(result_of(1), at_s(1));
  EXPECT_EQ((MapStore{store, *start.map}.roll_back(0, at_s(1.5))), 2u);
  outputs.save(result_of(2), at_s(2));
  EXPECT_FALSE(status("store").written);
  outputs.retry(at_s(4));
  EXPECT_TRUE(status("store").written) << status("store").why;
  outputs.save(result_of(3), at_s(5));
  EXPECT_EQ(warnings.size(), 2u);
  const MapStore kept{store, *start.map};
  EXPECT_EQ(kept.newest(), 4u);
  EXPECT_EQ(kept.grid(2), *start.map);
  for (const std::uint32_t number : {2u, 3u}) EXPECT_EQ(kept.grid(number + 1), *result_of(number).revision->map);
}

TEST_F(SavingMaps, ADiskThatIsFullAtTheStartAndFreeAtTheEnd) {
  std::optional<MapOutputs> outputs;
  MapOutputs::Options late = options();
  late.store.store.reset();
  late.store.open = [this] { return MapStore{store, *start.map}; };
  late.store.why_not = "store.sqlite: database or disk is full";
  {
    const test::FullDisk full;
    outputs.emplace(std::move(late), telemetry.outputs, warn(), at_s(0));
    outputs->save(result_of(1), at_s(1));
    EXPECT_EQ(warnings.size(), 4u);
  }
  outputs->close(at_s(1.5));
  outputs.reset();
  EXPECT_EQ(read_grid(out / "map.yaml"), *result_of(1).revision->map);
  EXPECT_EQ((MapStore{store, *start.map}.grid(1)), *result_of(1).revision->map);
  EXPECT_EQ((MapStore{out / "map_store.sqlite", *start.map}.newest()), 1u);
}

/// A store that cannot be opened before a test lets it.
class LateStore : public SavingMaps {
 protected:
  /// The settings' store alone, begun by a run that goes on with `revision` of it.
  [[nodiscard]] MapOutputs::Options late(std::uint32_t revision) {
    StoreToKeep to;
    to.open = [this] {
      if (!may_open) throw std::runtime_error("store.sqlite: cannot be opened");
      return MapStore{store, *start.map};
    };
    to.why_not = "store.sqlite: cannot be opened";
    may_open = false;
    return {.store_file = store,
            .store = std::move(to),
            .start = {.map = revision == 0 ? start.map : result_of(revision).revision->map, .revision = revision},
            .method = "evidence"};
  }
  void write_store(std::uint32_t revisions) const {
    MapStore written{store, *start.map};
    for (std::uint32_t number = 1; number <= revisions; ++number) {
      written.append(*result_of(number).revision, {.cause = "evidence"});
    }
  }
  /// Each revision that stands in the store, with its cause, holds the map of this run's revision.
  void expect_store(const std::vector<std::tuple<std::uint32_t, std::string, std::uint32_t>>& wanted) const {
    const MapStore kept{store, *start.map};
    std::vector<std::tuple<std::uint32_t, std::string, std::uint32_t>> told;
    for (const mapping::store::StoredRevision& one : kept.history()) {
      if (one.number > 0 && !one.refused)
        told.emplace_back(one.number, one.note.cause, cells_of(kept.grid(one.number)));
    }
    EXPECT_EQ(told, wanted);
  }
  /// Occupied ones: the number of the run's revision that made the map.
  static std::uint32_t cells_of(const OccupancyGrid& map) {
    return static_cast<std::uint32_t>(count_of(map, CellState::kOccupied));
  }
  bool may_open = false;
};

TEST_F(LateStore, InTwoRunsHoldsWhatBothHaveMissed) {
  for (const std::uint32_t begin : {0U, 3U}) {
    MapOutputs outputs{late(begin), telemetry.outputs, warn(), at_s(0)};
    for (std::uint32_t number : {begin + 1, begin + 2}) outputs.save(result_of(number), at_s(number));
    EXPECT_FALSE(status("store").written);
    may_open = true;
    outputs.retry(at_s(30));
    outputs.save(result_of(begin + 3), at_s(31));
    EXPECT_TRUE(status("store").written) << status("store").why;
    outputs.close(at_s(32));
  }
  expect_store(
      {{2, "evidence (1 to 2 in one)", 2}, {3, "evidence", 3}, {5, "evidence (4 to 5 in one)", 5}, {6, "evidence", 6}});
}

TEST_F(LateStore, GoesOnBehindAForeignRevisionAndNamesWhatWasMissedByItsNumbersThere) {
  write_store(3);
  MapOutputs outputs{late(3), telemetry.outputs, warn(), at_s(0)};
  for (std::uint32_t number : {4U, 5U}) outputs.save(result_of(number), at_s(number));
  EXPECT_EQ((MapStore{store, *start.map}.roll_back(1, at_s(6))), 4U);
  may_open = true;
  outputs.retry(at_s(30));
  outputs.save(result_of(6), at_s(31));
  outputs.close(at_s(32));
  EXPECT_EQ(warnings.size(), 2U) << "it pauses, it goes on";
  expect_store({{1, "evidence", 1},
                {2, "evidence", 2},
                {3, "evidence", 3},
                {4, "rolled back to 1", 1},
                {6, "evidence (5 to 6 in one)", 5},
                {7, "evidence", 6}});
}

TEST_F(LateStore, ThatIsAheadOfTheRunTakesItsNextMapWhole) {
  write_store(3);
  MapOutputs outputs{late(2), telemetry.outputs, warn(), at_s(0)};  // the newest could not be read
  may_open = true;
  outputs.retry(at_s(30));
  EXPECT_EQ(warnings.size(), 2U) << "it pauses, it goes on";
  outputs.save(result_of(3), at_s(31));
  EXPECT_EQ((MapStore{store, *start.map}.roll_back(1, at_s(32))), 5U);
  outputs.save(result_of(4), at_s(33));
  outputs.retry(at_s(60));
  outputs.save(result_of(5), at_s(61));
  outputs.close(at_s(62));
  EXPECT_EQ(warnings.size(), 4U) << "another program has written: it pauses, it goes on";
  expect_store({{1, "evidence", 1},
                {2, "evidence", 2},
                {3, "evidence", 3},
                {4, "evidence", 3},
                {5, "rolled back to 1", 1},
                {6, "evidence", 4},
                {7, "evidence", 5}});
}

TEST_F(LateStore, OnADiskWithoutRoomForALockIsLockedWhenItIsOpened) {
  if (getuid() != 0) GTEST_SKIP() << "only root can mount: run this test as root";
  const fs::path mounted = folder.path() / "mounted";
  fs::create_directory(mounted);
  if (mount("tmpfs", mounted.c_str(), "tmpfs", 0, "size=8m") != 0) GTEST_SKIP() << "nothing can be mounted here";
  store = mounted / "store.sqlite";
  write_store(3);
  EXPECT_EQ(mount(nullptr, mounted.c_str(), nullptr, MS_REMOUNT | MS_RDONLY, nullptr), 0);
  {
    OpenedStore opened = open_store(store, *start.map);
    MapOutputs outputs{
        {.store_file = store, .store = std::move(opened.store), .start = opened.start, .method = "evidence"},
        telemetry.outputs,
        warn(),
        at_s(0)};
    EXPECT_EQ(mount(nullptr, mounted.c_str(), nullptr, MS_REMOUNT, nullptr), 0);
    outputs.retry(at_s(30));
    EXPECT_TRUE(status("store").written) << status("store").why;
    EXPECT_THROW((void)open_store(store, *start.map), FileInUse);
  }
  {
    const FileLock another{store.string() + ".lock", "store.sqlite"};
    StoreToKeep to = late(3).store;
    to.to_lock = store;
    may_open = true;
    MapOutputs outputs{{.store_file = store, .store = std::move(to), .start = start, .method = "evidence"},
                       telemetry.outputs,
                       warn(),
                       at_s(0)};
    outputs.retry(at_s(30));
    EXPECT_FALSE(status("store").written);
    EXPECT_NE(status("store").why.find("is in use by"), std::string::npos) << status("store").why;
  }
  EXPECT_EQ(umount(mounted.c_str()), 0);
}

TEST_F(SavingMaps, TheHistoryOfARunThatCouldNotBeginItHoldsNothingOfTheRunBefore) {
  {
    MapStore before{out / "map_store.sqlite", *start.map};
    before.append(*result_of(1).revision, {.cause = "of the run before"});
  }
  fs::permissions(out, fs::perms{0555});
  std::optional<MapOutputs> outputs;
  {
    const test::NotRoot another_user;
    outputs.emplace(MapOutputs::Options{.out = out, .start = start, .method = "evidence"}, telemetry.outputs, warn(),
                    at_s(0));
    EXPECT_FALSE(status("history").written);
  }
  fs::permissions(out, fs::perms::all);
  outputs->save(result_of(1), at_s(30));
  outputs->close(at_s(31));
  outputs.reset();
  const MapStore kept{out / "map_store.sqlite", *start.map};
  EXPECT_EQ(kept.newest(), 1U);
  EXPECT_EQ(kept.history().back().note.cause, "evidence");
}

}  // namespace
}  // namespace deltamap::daemon
