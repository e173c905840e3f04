// SPDX-License-Identifier: Apache-2.0
// What a start finds in a store that is as it was left, what it tells of it, and where it may not open one at all.
#include "daemon/maps/store_opening.hpp"

#include <gtest/gtest.h>
#include <sys/mount.h>
#include <unistd.h>

#include <optional>
#include <utility>

#include "daemon/settings/start_error.hpp"
#include "tests/daemon/maps/stored_history.hpp"
#include "tests/support/files/full_disk.hpp"
#include "tests/support/files/not_root.hpp"

namespace deltamap::daemon {
namespace {

namespace fs = std::filesystem;
using mapping::store::MapStore;

class StoreOpening : public StoredHistory {};

TEST_F(StoreOpening, ASoundStoreGoesOn) {
  fill();
  const OpenedStore opened = open_store(file, first);
  EXPECT_TRUE(opened.warnings.empty());
  EXPECT_EQ(opened.start.revision, kRevisions);
  EXPECT_EQ(*opened.start.map, maps.back());
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
