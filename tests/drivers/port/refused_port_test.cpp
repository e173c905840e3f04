// SPDX-License-Identifier: Apache-2.0
// Ports that others hold or that are forbidden: who, since when, and what helps. The other program is a child process.
#include <fcntl.h>
#include <grp.h>
#include <gtest/gtest.h>
#include <signal.h>
#include <stdlib.h>
#include <sys/file.h>
#include <sys/ioctl.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include "drivers/port/port_holder.hpp"
#include "drivers/port/port_permission.hpp"
#include "drivers/port/terminal.hpp"
#include "tests/support/files/temporary_folder.hpp"

namespace deltamap::drivers::port {
namespace {

class RefusedPort : public testing::Test {
 protected:
  RefusedPort() : master_{::posix_openpt(O_RDWR | O_NOCTTY | O_NONBLOCK)} {
    (void)::grantpt(master_);
    (void)::unlockpt(master_);
    path_ = ::ptsname(master_);
  }
  ~RefusedPort() override {
    let_go();
    ::close(master_);
  }

  /// Another program that opens the device, does `claim` with it and stays.
  template <typename Claim>
  void hold_elsewhere(Claim&& claim) {
    int ready[2];
    ASSERT_EQ(::pipe(ready), 0);
    other_ = ::fork();
    ASSERT_GE(other_, 0);
    if (other_ == 0) {
      const int device = ::open(path_.c_str(), O_RDWR | O_NOCTTY);
      const char done = device >= 0 && claim(device) ? 'y' : 'n';
      (void)!::write(ready[1], &done, 1);
      for (;;) ::pause();
    }
    char done = 'n';
    ASSERT_EQ(::read(ready[0], &done, 1), 1);
    ASSERT_EQ(done, 'y');
    ::close(ready[0]);
    ::close(ready[1]);
  }
  void let_go() {
    if (other_ <= 0) return;
    ::kill(other_, SIGKILL);
    ::waitpid(other_, nullptr, 0);
    other_ = -1;
  }
  [[nodiscard]] std::string refusal() const {
    const OpenedTerminal opened = open_terminal(path_, 9600);
    if (opened.descriptor >= 0) close_terminal(opened.descriptor);
    return opened.refused;
  }
  void expect_the_other_is_named(const std::string& refused) const {
    EXPECT_NE(refused.find(" is busy: '"), std::string::npos) << refused;
    EXPECT_NE(refused.find("(pid " + std::to_string(other_) + ", running for "), std::string::npos) << refused;
  }

  int master_;
  std::string path_;
  pid_t other_ = -1;
};

TEST_F(RefusedPort, NamesTheProcessThatHasLockedIt) {
  hold_elsewhere([](int device) { return ::flock(device, LOCK_EX | LOCK_NB) == 0; });
  expect_the_other_is_named(refusal());
  let_go();
  EXPECT_EQ(refusal(), "");
}

TEST_F(RefusedPort, RespectsAndKeepsTheExclusiveModeOfAnotherProgram) {
  hold_elsewhere([](int device) { return ::ioctl(device, TIOCEXCL) == 0; });
  expect_the_other_is_named(refusal());
  expect_the_other_is_named(refusal());  // the first attempt has not taken it away
}

TEST_F(RefusedPort, TakesAPortThatAnotherProgramHasOpenWithoutClaimingIt) {
  hold_elsewhere([](int) { return true; });
  EXPECT_EQ(refusal(), "");
}

TEST_F(RefusedPort, LeavesAnExclusiveModeThatCameLaterToItsOwner) {
  const OpenedTerminal own = open_terminal(path_, 9600);
  ASSERT_GE(own.descriptor, 0) << own.refused;
  hold_elsewhere([&](int device) {
    ::close(own.descriptor);  // the child's copy of it
    return ::ioctl(device, TIOCEXCL) == 0;
  });
  close_terminal(own.descriptor);
  expect_the_other_is_named(refusal());
}

TEST_F(RefusedPort, BelievesLockFilesOfLivingProcessesAlone) {
  const test::TemporaryFolder locks;
  const std::string name = "LCK.." + path_.substr(path_.rfind('/') + 1);
  EXPECT_FALSE(lock_file_holder(path_, locks.path()));
  hold_elsewhere([](int) { return true; });
  locks.write(name, "     " + std::to_string(other_) + "\n");
  const auto holder = lock_file_holder(path_, locks.path());
  ASSERT_TRUE(holder);
  EXPECT_EQ(holder->pid, other_);
  const pid_t pid = other_;
  locks.write(name, std::string{reinterpret_cast<const char*>(&pid), sizeof pid});
  EXPECT_TRUE(lock_file_holder(path_, locks.path())) << "the binary form";
  const auto link = locks.path() / "laser";
  std::filesystem::create_symlink(path_, link);
  EXPECT_TRUE(lock_file_holder(link, locks.path())) << "under the name of the device itself";
  let_go();
  EXPECT_FALSE(lock_file_holder(path_, locks.path()));
  EXPECT_TRUE(std::filesystem::exists(locks.path() / name)) << "it is not ours to remove";
}

TEST(PortHolders, TellNamePidAndAge) {
  const PortHolders one{{{812, "minicom", 11000.0}}, true};
  EXPECT_EQ(one.told(), "'minicom' (pid 812, running for 3 h) has it open");
  const PortHolders two{{{1, "a b", 3.0}, {2, "c", 600.0}}, false};
  EXPECT_EQ(two.told(), "'a b' (pid 1, running for 2 s), 'c' (pid 2, running for 10 min) have it open");
  const PortHolders hidden{{}, false};
  EXPECT_EQ(hidden.told(), "a program of another user has it open");
}

/// Judged as a user who is neither owner nor in the group.
class ForbiddenPort : public testing::Test {
 protected:
  std::string way(uid_t owner, gid_t group, mode_t mode) {
    EXPECT_EQ(::chown(file_.c_str(), owner, group), 0);
    EXPECT_EQ(::chmod(file_.c_str(), mode), 0);
    constexpr uid_t kNobody = 65534;
    EXPECT_EQ(::seteuid(kNobody), 0);
    const std::string told = way_to_permission(file_);
    EXPECT_EQ(::seteuid(0), 0);
    return told;
  }
  void SetUp() override {
    if (::geteuid() != 0) GTEST_SKIP() << "needs root, to give the file to others";
    ASSERT_EQ(::chmod(folder_.path().c_str(), 0755), 0);
  }
  test::TemporaryFolder folder_;
  std::string file_ = folder_.write("device", "");
};

TEST_F(ForbiddenPort, NamesTheGroupOnlyWhereItWouldHelp) {
  const group* dialout = ::getgrnam("dialout");
  ASSERT_NE(dialout, nullptr);
  const gid_t id = dialout->gr_gid;
  EXPECT_EQ(way(0, id, 0660), "join the group 'dialout'");
  EXPECT_EQ(way(0, id, 0640), "only its owner 'root' may use it") << "the group may only read";
  EXPECT_EQ(way(0, id, 0600), "only its owner 'root' may use it");
  EXPECT_EQ(way(0, 0, 0660), "only its owner 'root' may use it") << "nobody should join root";
  EXPECT_EQ(way(1, id, 0600), "only its owner 'daemon' may use it");
  EXPECT_NE(way(0, id, 0).find("its mode lets nobody but root"), std::string::npos);
  EXPECT_NE(way(65534, id, 0060).find("its mode lets nobody but root"), std::string::npos) << "an owner has no group";
}

TEST_F(ForbiddenPort, NamesTheFolderThatIsClosed) {
  ASSERT_EQ(::chmod(folder_.path().c_str(), 0700), 0);
  EXPECT_EQ(way(0, 0, 0666), "the folder '" + folder_.path().string() + "' is closed to user 'nobody'");
}

/// A unit's device policy forbids access() as it forbids open(): the owner is not to blame.
TEST_F(ForbiddenPort, TheOwnerIsNotBlamedForWhatTheUnitForbids) {
  ASSERT_EQ(::chmod(file_.c_str(), 0), 0);
  constexpr uid_t kNobody = 65534;
  ASSERT_EQ(::seteuid(kNobody), 0);
  const std::string told = why_not_opened(file_, EPERM);
  ASSERT_EQ(::seteuid(0), 0);
  EXPECT_NE(told.find("by the unit of the service"), std::string::npos) << told;
  EXPECT_EQ(told.find("owner"), std::string::npos) << told;
}

TEST(PortPermission, WhatTheModeDoesNotForbidTheUnitDoes) {
  EXPECT_EQ(driver_of("/dev/null"), "mem");
  EXPECT_EQ(driver_of("/nowhere"), "");
  EXPECT_EQ(
      why_not_opened("/dev/null", EPERM),
      "is forbidden (Operation not permitted): not by its mode, but by the unit of the service: either the driver was "
      "loaded after the start of the service (sudo systemctl restart deltamap), or the unit lacks "
      "'DeviceAllow=char-mem "
      "rw' (sudo systemctl edit deltamap)");
}

}  // namespace
}  // namespace deltamap::drivers::port
