// SPDX-License-Identifier: Apache-2.0
#include "core/files/replace_file.hpp"

#include <gtest/gtest.h>
#include <sys/stat.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <filesystem>
#include <stdexcept>
#include <string>
#include <system_error>
#include <vector>

#include "tests/support/files/full_disk.hpp"
#include "tests/support/files/not_root.hpp"
#include "tests/support/files/temporary_folder.hpp"
#include "tests/support/files/text_file.hpp"

namespace {

/// What was synced, in order, and whether the new name existed at that time.
struct Synced {
  std::filesystem::path path;
  bool new_name_exists;
};
std::vector<Synced> synced;
std::filesystem::path watched;

}  // namespace

// In the place of the C library's: notes what it is asked for.
extern "C" int fsync(int descriptor) {
  std::error_code ignored;
  synced.push_back({std::filesystem::read_symlink("/proc/self/fd/" + std::to_string(descriptor), ignored),
                    std::filesystem::exists(watched, ignored)});
  return static_cast<int>(::syscall(SYS_fsync, descriptor));
}

namespace deltamap {
namespace {

namespace fs = std::filesystem;
using test::content_of;

TEST(ReplaceFile, SyncsTheContentBeforeTheNameAndTheFolderAfterIt) {
  const test::TemporaryFolder folder;
  watched = fs::canonical(folder.path()) / "kept";
  synced.clear();
  replace_file(watched, "new");
  EXPECT_EQ(content_of(watched), "new");
  ASSERT_EQ(synced.size(), 2u);
  EXPECT_EQ(synced[0].path, watched.string() + ".part");
  EXPECT_FALSE(synced[0].new_name_exists);
  EXPECT_EQ(synced[1].path, fs::canonical(folder.path()));
  EXPECT_TRUE(synced[1].new_name_exists);
}

TEST(ReplaceFile, TakesTheContentPieceByPiece) {
  const test::TemporaryFolder folder;
  const auto file = folder.write("kept", "old");
  std::vector<std::string_view> pieces{"one, ", "two, ", "three"};
  auto next = pieces.begin();
  replace_file(file, [&] { return next == pieces.end() ? std::string_view{} : *next++; });
  EXPECT_EQ(content_of(file), "one, two, three");
  {
    const test::FullDisk full{3};
    next = pieces.begin();
    EXPECT_THROW(replace_file(file, [&] { return *next++; }), std::runtime_error);
  }
  EXPECT_EQ(content_of(file), "one, two, three");
}

TEST(ReplaceFile, LeavesTheOldFileWhereTheDiskIsFull) {
  const test::TemporaryFolder folder;
  const auto file = folder.write("kept", "old");
  {
    const test::FullDisk full{3};
    EXPECT_THROW(replace_file(file, "longer than three bytes"), std::runtime_error);
  }
  EXPECT_EQ(content_of(file), "old");
  EXPECT_FALSE(fs::exists(file.string() + ".part"));
}

struct stat state_of(const fs::path& file) {
  struct stat state {};
  (void)::stat(file.c_str(), &state);
  return state;
}

TEST(ReplaceFile, KeepsWhoMayReadAndWriteTheFile) {
  const test::TemporaryFolder folder;
  const auto file = folder.write("shared", "old");
  for (const mode_t mode : {0664u, 0600u, 0444u, 0640u}) {
    ASSERT_EQ(::chmod(file.c_str(), mode), 0);
    replace_file(file, "new");
    EXPECT_EQ(state_of(file).st_mode & 07777u, mode);
  }
  replace_file(folder.path() / "first", "new");
  EXPECT_EQ(state_of(folder.path() / "first").st_mode & 0600u, 0600u) << "where none was it is as any new file";
}

TEST(ReplaceFile, KeepsOwnerAndGroupWhereItMay) {
  if (::geteuid() != 0) GTEST_SKIP() << "only root gives files away";
  const test::TemporaryFolder folder;
  const auto file = folder.write("shared", "old");
  ASSERT_EQ(::chown(file.c_str(), 65534, 65533), 0);
  replace_file(file, "new");
  EXPECT_EQ(state_of(file).st_uid, 65534u);
  EXPECT_EQ(state_of(file).st_gid, 65533u);
}

TEST(ReplaceFile, AnothersFileIsReplacedWithItsMode) {
  const test::TemporaryFolder folder;
  const auto file = folder.write("shared", "old");
  ASSERT_EQ(::chmod(file.c_str(), 0664), 0);
  ASSERT_EQ(::chmod(folder.path().c_str(), 0777), 0);
  const test::NotRoot another;
  replace_file(file, "new");
  EXPECT_EQ(content_of(file), "new");
  EXPECT_EQ(state_of(file).st_mode & 07777u, 0664u);
}

TEST(ReplaceFile, WhatAKilledRunHasLeftIsNotInTheWay) {
  const test::TemporaryFolder folder;
  const auto file = folder.write("kept", "old");
  const auto left = folder.write("kept.part", "half");
  ASSERT_EQ(::chmod(left.c_str(), 0400), 0);
  ASSERT_EQ(::chmod(folder.path().c_str(), 0777), 0);
  const test::NotRoot another;
  replace_file(file, "new");
  EXPECT_EQ(content_of(file), "new");
}

TEST(ReplaceFile, SaysByTheSystemsNumberWhyItCannot) {
  const test::TemporaryFolder folder;
  try {
    const test::FullDisk full{3};
    replace_file(folder.path() / "kept", "longer than three bytes");
    FAIL();
  } catch (const std::system_error& error) {
    EXPECT_EQ(error.code(), std::errc::file_too_large);
    EXPECT_NE(std::string(error.what()).find("kept: cannot be written: File too large"), std::string::npos);
  }
}

TEST(MoveIntoPlace, SyncsWhatItMoves) {
  const test::TemporaryFolder folder;
  const auto draft = folder.write("draft", "whole");
  watched = folder.path() / "place";
  synced.clear();
  move_into_place(draft, watched);
  EXPECT_EQ(content_of(watched), "whole");
  EXPECT_EQ(synced.size(), 2u);
  EXPECT_THROW(move_into_place(folder.path() / "missing", watched), std::runtime_error);
}

}  // namespace
}  // namespace deltamap
