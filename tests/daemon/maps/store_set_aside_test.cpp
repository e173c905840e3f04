// SPDX-License-Identifier: Apache-2.0
// A store that is no good does not keep the daemon from its work: it is set aside whole, and all that can be had of it
// goes on.
#include <gtest/gtest.h>
#include <sqlite3.h>

#include <fstream>

#include "daemon/maps/store_opening.hpp"
#include "tests/daemon/maps/stored_history.hpp"
#include "tests/support/files/not_root.hpp"
#include "tests/support/files/text_file.hpp"

namespace deltamap::daemon {
namespace {

namespace fs = std::filesystem;
using mapping::store::MapStore;
using test::content_of;

class StoreSetAside : public StoredHistory {
 protected:
  void overwrite(std::size_t offset, const std::string& bytes) const {
    std::fstream out(file, std::ios::binary | std::ios::in | std::ios::out);
    out.seekp(static_cast<std::streamoff>(offset));
    out << bytes;
  }

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
};

TEST_F(StoreSetAside, AStoreThatWasCutIsSetAsideAndAMapInItGoesOn) {
  fill();
  fs::resize_file(file, fs::file_size(file) * 3 / 4);
  EXPECT_GE(expect_set_aside(), 64u);
}

TEST_F(StoreSetAside, AWholePageOfOtherBytesCostsNoRevision) {
  fill();
  const auto size = static_cast<std::size_t>(fs::file_size(file));
  overwrite(size - 4096, std::string(4096, '\x5A'));
  EXPECT_EQ(expect_set_aside(), kRevisions);
  expect_every_revision("the last page");
}

TEST_F(StoreSetAside, AFlippedByteCostsNoRevisionAndTheDamagedStoreIsKeptWhole) {
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

TEST_F(StoreSetAside, WhatIsLostIsToldByNumber) {
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

TEST_F(StoreSetAside, AFileThatWasEmptiedIsKeptAsideAndWhatItHeldIsToldByNumber) {
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

TEST_F(StoreSetAside, WhereTheFileWasEmptiedItsLogIsNotDeleted) {
  (void)folder.write("store.sqlite", "");
  (void)folder.write("store.sqlite-wal", "what was not in the file yet");
  const OpenedStore opened = open_store(file, first);
  EXPECT_EQ(opened.warnings.size(), 1u);
  EXPECT_TRUE(opened.store.store);
  EXPECT_EQ(content_of(file.string() + ".set-aside-1-wal"), "what was not in the file yet");
}

TEST_F(StoreSetAside, OfAFileThatWasCutTheRangeBehindTheCutIsTold) {
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

TEST_F(StoreSetAside, AKillInTheMidstOfARecoveryIsMadeGoodByTheNextStart) {
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

TEST_F(StoreSetAside, DamageAnywhereNeverEndsTheStart) {
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

TEST_F(StoreSetAside, GarbageAndAForeignDatabaseAreSetAside) {
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

TEST_F(StoreSetAside, SetAsideNeverReplacesWhatWasSetAsideBefore) {
  maps.push_back(first);
  (void)folder.write("store.sqlite.set-aside-1", "older");
  (void)folder.write("store.sqlite", std::string(10'000, 'x'));
  (void)open_store(file, first);
  EXPECT_EQ(content_of(file.string() + ".set-aside-1"), "older");
  EXPECT_EQ(fs::file_size(file.string() + ".set-aside-2"), 10'000u);
}

TEST_F(StoreSetAside, BehindALinkTheDatabaseIsSetAsideAndNotTheLink) {
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

TEST_F(StoreSetAside, AReadOnlyFileIsSetAsideAndItsMapGoesOn) {
  fill();
  fs::permissions(folder.path(), fs::perms::all);
  fs::permissions(file, fs::perms::owner_read | fs::perms::group_read | fs::perms::others_read);
  const test::NotRoot another_user;
  EXPECT_EQ(expect_set_aside(), kRevisions);
}

}  // namespace
}  // namespace deltamap::daemon
