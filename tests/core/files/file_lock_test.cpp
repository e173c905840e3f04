// SPDX-License-Identifier: Apache-2.0
#include "core/files/file_lock.hpp"

#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>

#include "tests/support/files/not_root.hpp"
#include "tests/support/files/temporary_folder.hpp"

namespace deltamap {
namespace {

std::string refused_lock(const std::filesystem::path& file) {
  try {
    (void)lock_of_file(file);
  } catch (const FileInUse& error) {
    return error.what();
  }
  return "";
}

TEST(FileLock, NamesTheProgramThatHoldsIt) {
  const test::TemporaryFolder folder;
  const auto file = folder.path() / "store.sqlite";
  {
    const auto lock = lock_of_file(file);
    EXPECT_EQ(refused_lock(file), file.string() + ": is in use by " + program_invocation_short_name + " (pid " +
                                      std::to_string(getpid()) + ")");
  }
  EXPECT_EQ(refused_lock(file), "");
  EXPECT_TRUE(std::filesystem::is_empty(folder.path())) << "a lock that was let go leaves nothing behind";
}

TEST(FileLock, OfAProgramThatWasKilledIsFree) {
  const test::TemporaryFolder folder;
  const auto file = folder.path() / "store.sqlite";
  int ready[2];
  ASSERT_EQ(pipe(ready), 0);
  const pid_t child = fork();
  if (child == 0) {
    const auto lock = lock_of_file(file);
    (void)!write(ready[1], "x", 1);
    pause();
  }
  char byte = 0;
  ASSERT_EQ(read(ready[0], &byte, 1), 1);
  EXPECT_NE(refused_lock(file).find("(pid " + std::to_string(child) + ")"), std::string::npos) << refused_lock(file);
  kill(child, SIGKILL);
  waitpid(child, nullptr, 0);
  ASSERT_TRUE(std::filesystem::exists(file.string() + ".lock")) << "what a kill leaves behind";
  EXPECT_EQ(refused_lock(file), "");
}

TEST(FileLock, OfAFolderIsOneForAllInIt) {
  const test::TemporaryFolder folder;
  const auto lock = lock_of_folder(folder.path());
  EXPECT_THROW((void)lock_of_folder(folder.path() / "."), FileInUse);
}

TEST(FileLock, OfAnotherUserIsRespectedThroughAFileThatMayOnlyBeRead) {
  const test::TemporaryFolder folder;
  const auto file = folder.path() / "store.sqlite";
  const auto lock = lock_of_file(file);
  const auto lock_file = file.string() + ".lock";
  std::filesystem::permissions(folder.path(), std::filesystem::perms::all);
  std::filesystem::permissions(lock_file, std::filesystem::perms{0444});
  const test::NotRoot another_user;
  EXPECT_NE(refused_lock(file).find("(pid " + std::to_string(getpid()) + ")"), std::string::npos) << refused_lock(file);
}

TEST(FileLock, IsThatOfTheFileBehindALink) {
  const test::TemporaryFolder folder;
  const auto file = folder.path() / "store.sqlite";
  std::filesystem::create_directory(folder.path() / "links");
  std::filesystem::create_symlink("../store.sqlite", folder.path() / "links/link");
  std::filesystem::create_symlink(folder.path() / "links/link", folder.path() / "link");
  for (const bool exists : {false, true}) {
    if (exists) (void)folder.write("store.sqlite", "");
    const auto lock = lock_of_file(file);
    EXPECT_NE(refused_lock(folder.path() / "link"), "") << exists;
    EXPECT_NE(refused_lock(folder.path() / "links/link"), "") << exists;
  }
}

TEST(FileLock, LeftByAnotherUserIsReplacedByOneThatNamesItsHolder) {
  const test::TemporaryFolder folder;
  const auto file = folder.path() / "store.sqlite";
  (void)folder.write("store.sqlite.lock", "deltamapd (pid 1)\n");
  std::filesystem::permissions(folder.path(), std::filesystem::perms::all);
  std::filesystem::permissions(file.string() + ".lock", std::filesystem::perms{0444});
  const test::NotRoot another_user;
  const auto lock = lock_of_file(file);
  EXPECT_NE(refused_lock(file).find("(pid " + std::to_string(getpid()) + ")"), std::string::npos) << refused_lock(file);
}

TEST(FileLock, ThatMayNotEvenBeReadIsAnError) {
  const test::TemporaryFolder folder;
  std::filesystem::permissions(folder.write("store.sqlite.lock", ""), std::filesystem::perms::none);
  std::filesystem::permissions(folder.path(), std::filesystem::perms::all);
  const test::NotRoot another_user;
  EXPECT_THROW((void)lock_of_file(folder.path() / "store.sqlite"), std::system_error);
}

TEST(FileLock, OfANewFileInThePresentFolder) {
  const test::TemporaryFolder folder;
  const auto before = std::filesystem::current_path();
  std::filesystem::current_path(folder.path());
  EXPECT_EQ(file_behind("store.sqlite"), std::filesystem::canonical(folder.path()) / "store.sqlite");
  EXPECT_NO_THROW(require_lockable_file("store.sqlite"));
  EXPECT_TRUE(lock_of_file("store.sqlite"));
  std::filesystem::current_path(before);
}

TEST(FileLock, BehindAFolderThatMayNotBeEnteredTellsSo) {
  const test::TemporaryFolder folder;
  const auto file = folder.path() / "inside/store.sqlite";
  std::filesystem::create_directory(folder.path() / "inside");
  std::filesystem::permissions(folder.path() / "inside", std::filesystem::perms::none);
  const test::NotRoot another_user;
  try {
    (void)file_behind(file);
    ADD_FAILURE() << "it was seen";
  } catch (const std::system_error& error) {
    EXPECT_EQ(error.what(), file.string() + ": cannot be looked at: Permission denied");
  }
}

TEST(FileLock, WhereThereIsNoFolderIsAnError) {
  EXPECT_THROW((void)lock_of_file("/nowhere/store.sqlite"), std::system_error);
}

}  // namespace
}  // namespace deltamap
