// SPDX-License-Identifier: Apache-2.0
// A store that is no good does not keep the daemon from its work: it is set aside whole, and all that can be had of it
// goes on.
#include "daemon/maps/store_opening.hpp"

#include <gtest/gtest.h>
#include <sqlite3.h>
#include <sys/mount.h>
#include <unistd.h>

#include <fstream>

#include "core/random.hpp"
#include "daemon/kept/kept_pose.hpp"
#include "daemon/settings/start_error.hpp"
#include "mapping/store/map_store.hpp"
#include "tests/support/files/full_disk.hpp"
#include "tests/support/files/not_root.hpp"
#include "tests/support/files/temporary_folder.hpp"
#include "tests/support/files/text_file.hpp"

namespace deltamap::daemon {
namespace {

using test::content_of;

namespace fs = std::filesystem;
using mapping::store::MapStore;

class StoreOpening : public testing::Test {
 protected:
  static constexpr std::uint32_t kRevisions = 150;  // more than two whole grids

  static OccupancyGrid first_map(int side = 200) {
    OccupancyGrid grid{{side, side, 0.1, {0.0, 0.0}}, CellState::kFree};
    Random random{1};  // runs that do not shrink to nothing
    for (int i = 0; i < 4000; ++i) grid.set(cell_of(random, side), CellState::kOccupied);
    return grid;
  }
  static Cell cell_of(Random& random, int side) {
    const auto size = static_cast<std::uint32_t>(side);
    return {static_cast<int>(random.index_below(size)), static_cast<int>(random.index_below(size))};
  }

  void fill() {
    MapStore store{file, first};
    Random random{2};
    maps.push_back(first);
    for (std::uint32_t number = 1; number <= kRevisions; ++number) {
      OccupancyGrid after = maps.back();
      for (int i = 0; i < 30; ++i) after.set(cell_of(random, 200), CellState::kUnknown);
      MapRevision revision{.number = number,
                           .time = timestamp_from_ns(number),
                           .map = std::make_shared<const OccupancyGrid>(after),
                           .changes = changes_between(maps.back(), after),
                           .field_patch = {}};
      store.append(revision, {.cause = "evidence"});
      maps.push_back(std::move(after));
    }
  }

  void overwrite(std::size_t offset, const std::string& bytes) const {
    std::fstream out(file, std::ios::binary | std::ios::in | std::ios::out);
    out.seekp(static_cast<std::streamoff>(offset));
    out << bytes;
  }

  /// As a run does that has known so many revisions.
  void keep_pose_of(std::uint32_t revision, std::uint64_t first_map) const {
    KeptPose pose;
    pose.first_map = first_map;
    pose.revision = revision;
    (void)folder.write("store.pose.json", json_text(pose));
  }
  void keep_pose_of(std::uint32_t revision) const { keep_pose_of(revision, grid_hash(first)); }

  /// Every revision is there as it was written.
  void expect_every_revision(const std::string& what) {
    const MapStore store{file, first};
    ASSERT_EQ(store.newest(), kRevisions) << what;
    for (std::uint32_t number = 0; number <= kRevisions; ++number) {
      ASSERT_EQ(store.grid(number), maps[number]) << what << ", revision " << number;
    }
  }

  /// The store was set aside untouched, and the run goes on with a map that the old one held; answers its number.
  std::uint32_t expect_set_aside() {
    const std::string before = content_of(file);
    std::uint32_t number = 0;
    {
      OpenedStore opened = open_store(file, first);
      EXPECT_EQ(opened.warnings.size(), 1u);
      if (!opened.warnings.empty()) {
        EXPECT_EQ(opened.warnings[0].find("map store set aside as " + file.string() + ".set-aside-1: "), 0u)
            << opened.warnings[0];
      }
      EXPECT_EQ(content_of(file.string() + ".set-aside-1"), before);
      number = opened.start.revision;
      EXPECT_EQ(*opened.start.map, maps[number]);
      EXPECT_TRUE(opened.store.store);
    }
    OpenedStore again = open_store(file, first);
    EXPECT_TRUE(again.warnings.empty()) << again.warnings[0];
    EXPECT_EQ(again.start.revision, number);
    EXPECT_EQ(*again.start.map, maps[number]);
    return number;
  }

  test::TemporaryFolder folder;
  fs::path file = folder.path() / "store.sqlite";
  OccupancyGrid first = first_map();
  std::vector<OccupancyGrid> maps{};
};

TEST_F(StoreOpening, ASoundStoreGoesOn) {
  fill();
  const OpenedStore opened = open_store(file, first);
  EXPECT_TRUE(opened.warnings.empty());
  EXPECT_EQ(opened.start.revision, kRevisions);
  EXPECT_EQ(*opened.start.map, maps.back());
}

TEST_F(StoreOpening, AStoreThatWasCutIsSetAsideAndAMapInItGoesOn) {
  fill();
  fs::resize_file(file, fs::file_size(file) * 3 / 4);
  EXPECT_GE(expect_set_aside(), 64u);
}

TEST_F(StoreOpening, AWholePageOfOtherBytesCostsNoRevision) {
  fill();
  const auto size = static_cast<std::size_t>(fs::file_size(file));
  overwrite(size - 4096, std::string(4096, '\x5A'));
  EXPECT_EQ(expect_set_aside(), kRevisions);
  expect_every_revision("the last page");
}

TEST_F(StoreOpening, AFlippedByteCostsNoRevisionAndTheDamagedStoreIsKeptWhole) {
  fill();
  const std::string whole = content_of(file);
  Random random{3};
  int set_aside = 0;
  for (int i = 0; i < 40; ++i) {
    std::string damaged = whole;
    const std::size_t at = random.index_below(static_cast<std::uint32_t>(whole.size()));
    damaged[at] = static_cast<char>(damaged[at] ^ static_cast<char>(1 + random.index_below(255)));
    (void)folder.write("store.sqlite", damaged);
    {
      const OpenedStore opened = open_store(file, first);
      EXPECT_EQ(opened.start.revision, kRevisions) << at;
      EXPECT_EQ(*opened.start.map, maps.back()) << at;
      if (!opened.warnings.empty()) {
        ++set_aside;
        EXPECT_NE(opened.warnings[0].find("; 150 revisions recovered"), std::string::npos) << opened.warnings[0];
        EXPECT_EQ(content_of(file.string() + ".set-aside-1"), damaged) << at;
      }
    }
    expect_every_revision(std::to_string(at));
    fs::remove(file.string() + ".set-aside-1");
  }
  EXPECT_GT(set_aside, 20);
}

TEST_F(StoreOpening, WhatIsLostIsToldByNumber) {
  fill();
  sqlite3* database = nullptr;
  ASSERT_EQ(sqlite3_open(file.c_str(), &database), SQLITE_OK);
  for (const char* sql : {"UPDATE revision SET changes = x'FF' WHERE number IN (30, 140, 141)",
                          "UPDATE revision_copy SET changes = x'FF' WHERE number IN (30, 140, 141)"}) {
    EXPECT_EQ(sqlite3_exec(database, sql, nullptr, nullptr, nullptr), SQLITE_OK);
  }
  sqlite3_close(database);
  const OpenedStore opened = open_store(file, first);
  ASSERT_EQ(opened.warnings.size(), 1u);
  EXPECT_NE(opened.warnings[0].find("; 148 revisions recovered, of these computed from their neighbours: 30; lost for "
                                    "good: 140 to 141 (later maps are without what these alone have changed)"),
            std::string::npos)
      << opened.warnings[0];
  EXPECT_EQ(opened.start.revision, kRevisions);
}

TEST_F(StoreOpening, AFileThatWasEmptiedIsKeptAsideAndWhatItHeldIsToldByNumber) {
  fill();
  keep_pose_of(kRevisions);
  fs::resize_file(file, 0);
  {
    const OpenedStore opened = open_store(file, first);
    ASSERT_EQ(opened.warnings.size(), 1u);
    EXPECT_EQ(opened.warnings[0], "map store set aside as " + file.string() + ".set-aside-1: " + file.string() +
                                      ": is empty; nothing of this first map's history can be recovered: begins with "
                                      "the first map; lost for good: 1 to 150");
    EXPECT_EQ(opened.start.revision, 0u);
    EXPECT_TRUE(opened.store.store);
  }
  EXPECT_EQ(fs::file_size(file.string() + ".set-aside-1"), 0u);
  const OpenedStore again = open_store(file, first);
  ASSERT_EQ(again.warnings.size(), 1u) << "until a pose of the new history is kept";
  EXPECT_NE(again.warnings[0].find(": 1 to 150 are missing"), std::string::npos) << again.warnings[0];
}

TEST_F(StoreOpening, WhereTheFileWasEmptiedItsLogIsNotDeleted) {
  (void)folder.write("store.sqlite", "");
  (void)folder.write("store.sqlite-wal", "what was not in the file yet");
  const OpenedStore opened = open_store(file, first);
  EXPECT_EQ(opened.warnings.size(), 1u);
  EXPECT_TRUE(opened.store.store);
  EXPECT_EQ(content_of(file.string() + ".set-aside-1-wal"), "what was not in the file yet");
}

TEST_F(StoreOpening, ANewFileThatAKilledStartHasLeftEmptyIsNoLoss) {
  (void)folder.write("store.sqlite", "");
  const OpenedStore opened = open_store(file, first);
  EXPECT_TRUE(opened.warnings.empty());
  EXPECT_FALSE(fs::exists(file.string() + ".set-aside-1"));
}

TEST_F(StoreOpening, RevisionsThatOnlyTheKeptPoseTellsOfAreToldToBeMissing) {
  fill();
  for (const auto& [known, missing] : {std::pair{kRevisions, std::string{}},
                                       {kRevisions + 1, ": 151 is missing"},
                                       {kRevisions + 20, ": 151 to 170 are missing"}}) {
    keep_pose_of(known);
    const OpenedStore opened = open_store(file, first);
    EXPECT_EQ(opened.start.revision, kRevisions);
    ASSERT_EQ(opened.warnings.size(), missing.empty() ? 0u : 1u);
    if (!missing.empty()) {
      EXPECT_NE(opened.warnings[0].find(missing), std::string::npos) << opened.warnings[0];
    }
    EXPECT_FALSE(fs::exists(file.string() + ".set-aside-1"));
  }
  keep_pose_of(1000, grid_hash(first) + 1);
  EXPECT_TRUE(open_store(file, first).warnings.empty()) << "of another map";
}

TEST_F(StoreOpening, OfAFileThatWasCutTheRangeBehindTheCutIsTold) {
  fill();
  keep_pose_of(kRevisions);
  fs::resize_file(file, fs::file_size(file) / 2);
  const OpenedStore opened = open_store(file, first);
  ASSERT_EQ(opened.warnings.size(), 1u);
  ASSERT_LT(opened.start.revision, kRevisions);
  const std::string range = std::to_string(opened.start.revision + 1) + " to 150";
  EXPECT_NE(opened.warnings[0].find("; lost for good: "), std::string::npos) << opened.warnings[0];
  EXPECT_NE(opened.warnings[0].find(range), std::string::npos) << opened.warnings[0];
}

TEST_F(StoreOpening, AKillInTheMidstOfARecoveryIsMadeGoodByTheNextStart) {
  fill();
  const std::string whole = content_of(file);
  const std::string damaged = std::string(100, 'x') + whole.substr(100);
  const fs::path recovered = file.string() + ".recovered";
  const fs::path aside = file.string() + ".set-aside-1";

  (void)folder.write("store.sqlite", damaged);  // while it was written
  (void)folder.write("store.sqlite.recovering", "half of it");
  EXPECT_EQ(open_store(file, first).start.revision, kRevisions);
  EXPECT_FALSE(fs::exists(file.string() + ".recovering"));
  EXPECT_EQ(content_of(aside), damaged);
  fs::remove(aside);

  (void)folder.write("store.sqlite", damaged);  // before the damaged one was set aside
  (void)folder.write("store.sqlite.recovered", whole);
  EXPECT_EQ(open_store(file, first).start.revision, kRevisions);
  EXPECT_EQ(content_of(aside), damaged);
  EXPECT_FALSE(fs::exists(recovered));

  fs::remove(file);  // after that
  (void)folder.write("store.sqlite.recovered", whole);
  EXPECT_EQ(open_store(file, first).start.revision, kRevisions);
  EXPECT_FALSE(fs::exists(recovered));
  expect_every_revision("in its place");
}

TEST_F(StoreOpening, ARunBeginsWithWhatIsProvisional) {
  fill();
  const std::vector<std::uint32_t> numbers{148, 150};
  {
    MapStore store{file, first};
    store.set_provisional(numbers);
  }
  const OpenedStore opened = open_store(file, first);
  ASSERT_EQ(opened.start.provisional.size(), 2u);
  for (std::size_t i = 0; i < 2; ++i) {
    EXPECT_EQ(opened.start.provisional[i].number, numbers[i]);
    EXPECT_EQ(opened.start.provisional[i].changes, changes_between(maps[numbers[i] - 1], maps[numbers[i]]));
  }
}

TEST_F(StoreOpening, DamageAnywhereNeverEndsTheStart) {
  fill();
  const std::string whole = content_of(file);
  Random random{7};
  int set_aside = 0;
  for (int i = 0; i < 60; ++i) {
    (void)folder.write("store.sqlite", whole);
    const std::size_t at = random.index_below(static_cast<std::uint32_t>(whole.size() - 200));
    std::string noise;
    for (int n = 0; n < 200; ++n) noise += static_cast<char>(random.index_below(256));
    overwrite(at, noise);
    const OpenedStore opened = open_store(file, first);
    EXPECT_EQ(*opened.start.map, maps[opened.start.revision]) << at;
    EXPECT_TRUE(opened.store.store) << at;
    for (const std::string& warning : opened.warnings) set_aside += warning.find("set aside") != std::string::npos;
  }
  EXPECT_GT(set_aside, 5) << "some of it must have been damage that shows";
}

TEST_F(StoreOpening, GarbageAndAForeignDatabaseAreSetAside) {
  maps.push_back(first);
  (void)folder.write("store.sqlite", std::string(10'000, 'x'));
  EXPECT_EQ(expect_set_aside(), 0u);
  fs::remove(file.string() + ".set-aside-1");
  for (const char* part : {"", "-wal", "-shm"}) fs::remove(file.string() + part);
  sqlite3* songs = nullptr;
  ASSERT_EQ(sqlite3_open(file.c_str(), &songs), SQLITE_OK);
  EXPECT_EQ(sqlite3_exec(songs, "CREATE TABLE songs (name TEXT)", nullptr, nullptr, nullptr), SQLITE_OK);
  sqlite3_close(songs);
  EXPECT_EQ(expect_set_aside(), 0u);
}

TEST_F(StoreOpening, SetAsideNeverReplacesWhatWasSetAsideBefore) {
  maps.push_back(first);
  (void)folder.write("store.sqlite.set-aside-1", "older");
  (void)folder.write("store.sqlite", std::string(10'000, 'x'));
  (void)open_store(file, first);
  EXPECT_EQ(content_of(file.string() + ".set-aside-1"), "older");
  EXPECT_EQ(fs::file_size(file.string() + ".set-aside-2"), 10'000u);
}

TEST_F(StoreOpening, BehindALinkTheDatabaseIsSetAsideAndNotTheLink) {
  (void)folder.write("store.sqlite", std::string(10'000, 'x'));
  fs::create_directory(folder.path() / "links");
  const fs::path link = folder.path() / "links" / "link.sqlite";
  fs::create_symlink(file, link);
  const OpenedStore opened = open_store(link, first);
  EXPECT_EQ(fs::file_size(file.string() + ".set-aside-1"), 10'000u);
  EXPECT_TRUE(fs::is_symlink(link));
  EXPECT_TRUE(opened.store.store);
  EXPECT_EQ((MapStore{file, first}.newest()), 0u);
  EXPECT_THROW((void)open_store(file, first), FileInUse);
}

TEST_F(StoreOpening, AnotherMapBeginsItsOwnHistoryInTheSameFile) {
  fill();
  OccupancyGrid other = first;
  other.set({3, 3}, CellState::kUnknown);
  const OpenedStore opened = open_store(file, other);
  ASSERT_EQ(opened.warnings.size(), 1u) << "whoever has edited the first map must know what that costs";
  EXPECT_EQ(opened.warnings.front().find("map store: holds "), 0u) << opened.warnings.front();
  EXPECT_NE(opened.warnings.front().find(" of another first map and none of this one"), std::string::npos);
  EXPECT_EQ(opened.start.revision, 0u);
  EXPECT_EQ(*opened.start.map, other);
}

TEST_F(StoreOpening, AFullDiskIsNoDamageAndTheNewestMapGoesOn) {
  fill();
  std::optional<OpenedStore> opened;
  {
    const test::FullDisk full;
    opened = open_store(file, first);
  }
  EXPECT_EQ(opened->start.revision, kRevisions);
  EXPECT_EQ(*opened->start.map, maps.back());
  EXPECT_FALSE(opened->store.store);
  EXPECT_NE(opened->store.why_not, "");
  EXPECT_FALSE(fs::exists(file.string() + ".set-aside-1"));
  EXPECT_EQ(opened->store.open().newest(), kRevisions) << "there is room again";
}

TEST_F(StoreOpening, AReadOnlyFileSystemIsReadAndTriedAgain) {
  if (getuid() != 0) GTEST_SKIP() << "only root can mount: run this test as root";
  fill();
  const fs::path mounted = folder.path() / "mounted";
  fs::create_directory(mounted);
  if (mount("tmpfs", mounted.c_str(), "tmpfs", 0, "size=8m") != 0) GTEST_SKIP() << "nothing can be mounted here";
  fs::copy_file(file, mounted / "store.sqlite");
  EXPECT_EQ(mount(nullptr, mounted.c_str(), nullptr, MS_REMOUNT | MS_RDONLY, nullptr), 0);
  {
    OpenedStore opened = open_store(mounted / "store.sqlite", first);
    EXPECT_EQ(opened.start.revision, kRevisions);
    EXPECT_EQ(*opened.start.map, maps.back());
    EXPECT_FALSE(opened.store.store);
    EXPECT_EQ(opened.warnings.size(), 1u);
    EXPECT_THROW((void)opened.store.open(), std::runtime_error);
    EXPECT_EQ(mount(nullptr, mounted.c_str(), nullptr, MS_REMOUNT, nullptr), 0);
    EXPECT_EQ(opened.store.open().newest(), kRevisions);
  }
  EXPECT_EQ(umount(mounted.c_str()), 0);
}

TEST_F(StoreOpening, AReadOnlyFileIsSetAsideAndItsMapGoesOn) {
  fill();
  fs::permissions(folder.path(), fs::perms::all);
  fs::permissions(file, fs::perms::owner_read | fs::perms::group_read | fs::perms::others_read);
  const test::NotRoot another_user;
  EXPECT_EQ(expect_set_aside(), kRevisions);
}

TEST_F(StoreOpening, AStoreInUseIsRefusedByTheNameOfItsHolder) {
  const OpenedStore opened = open_store(file, first);
  try {
    (void)open_store(file, first);
    FAIL() << "it is in use";
  } catch (const FileInUse& error) {
    EXPECT_NE(std::string(error.what()).find("(pid " + std::to_string(getpid()) + ")"), std::string::npos);
  }
}

TEST_F(StoreOpening, OfADaemonOfAnotherUserIsNotTakenAway) {
  fill();
  const OpenedStore opened = open_store(file, first);
  for (const char* part : {"", ".lock"}) fs::permissions(file.string() + part, fs::perms{0444});
  fs::permissions(folder.path(), fs::perms::all);
  const test::NotRoot another_user;
  EXPECT_THROW((void)open_store(file, first), FileInUse);
  EXPECT_TRUE(fs::exists(file));
  EXPECT_FALSE(fs::exists(file.string() + ".set-aside-1"));
}

TEST_F(StoreOpening, ThatCannotBeLockedIsNeverSetAside) {
  (void)folder.write("store.sqlite", std::string(10'000, 'x'));
  fs::permissions(folder.write("store.sqlite.lock", ""), fs::perms::none);
  fs::permissions(folder.path(), fs::perms::all);
  const test::NotRoot another_user;
  EXPECT_THROW((void)open_store(file, first), StartError);
  EXPECT_EQ(fs::file_size(file), 10'000u);
  EXPECT_FALSE(fs::exists(file.string() + ".set-aside-1"));
}

TEST_F(StoreOpening, APlaceThatIsNoneIsAPersonsMistake) {
  EXPECT_THROW((void)open_store(folder.path() / "missing" / "store.sqlite", first), StartError);
  EXPECT_THROW((void)open_store(folder.path(), first), StartError);
}

}  // namespace
}  // namespace deltamap::daemon
