// SPDX-License-Identifier: Apache-2.0
#include "core/files/keep_earlier.hpp"

#include <gtest/gtest.h>
#include <sys/stat.h>

#include <iterator>
#include <system_error>

#include "tests/support/files/full_disk.hpp"
#include "tests/support/files/temporary_folder.hpp"
#include "tests/support/files/text_file.hpp"

namespace deltamap {
namespace {

namespace fs = std::filesystem;
using test::content_of;

constexpr Timestamp kNow = timestamp_from_ns(1'764'500'400'000'000'000);

std::ptrdiff_t files_in(const fs::path& folder) {
  return std::distance(fs::directory_iterator(folder), fs::directory_iterator{});
}

TEST(KeepEarlier, WhatStoodThereStaysBesideItUnderANewName) {
  const test::TemporaryFolder folder;
  const auto file = folder.write("bays.yaml", "old");
  ASSERT_EQ(::chmod(file.c_str(), 0600), 0);
  const fs::path kept = replace_and_keep(file, "old", "new", kNow);
  EXPECT_EQ(kept, fs::canonical(folder.path()) / "bays.20251130T110000Z.yaml");
  EXPECT_EQ(content_of(kept), "old");
  EXPECT_EQ(content_of(file), "new");
  EXPECT_EQ(fs::status(kept).permissions(), fs::perms{0600}) << "read by nobody who might not read it before";
  EXPECT_EQ(replace_and_keep(file, "new", "newer", kNow).filename(), "bays.20251130T110000Z-2.yaml");
  EXPECT_EQ(content_of(kept), "old");
}

TEST(KeepEarlier, ALinkStaysOne) {
  const test::TemporaryFolder folder;
  fs::create_directory(folder.path() / "behind");
  const auto file = folder.write("behind/bays.yaml", "old");
  fs::create_symlink(file, folder.path() / "bays.yaml");
  const fs::path kept = replace_and_keep(folder.path() / "bays.yaml", "old", "new", kNow);
  EXPECT_TRUE(fs::is_symlink(folder.path() / "bays.yaml"));
  EXPECT_EQ(content_of(file), "new");
  EXPECT_EQ(kept.parent_path(), fs::canonical(file).parent_path());
}

TEST(KeepEarlier, AFullDiskLeavesAllAsItWas) {
  const test::TemporaryFolder folder;
  const auto file = folder.write("bays.yaml", "old");
  {
    const test::FullDisk full{3};  // enough for the old one
    EXPECT_THROW((void)replace_and_keep(file, "old", "a longer one", kNow), std::system_error);
  }
  EXPECT_EQ(content_of(file), "old");
  EXPECT_EQ(files_in(folder.path()), 1);
}

}  // namespace
}  // namespace deltamap
