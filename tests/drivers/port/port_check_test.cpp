// SPDX-License-Identifier: Apache-2.0
#include "drivers/port/port_check.hpp"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <stdlib.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include "tests/support/files/temporary_folder.hpp"

namespace deltamap::drivers::port {
namespace {

using State = PortCheck::State;

/// A pseudo-terminal whose both ends are open, as a simulator holds it.
class PortCheckTest : public testing::Test {
 protected:
  void SetUp() override {
    ASSERT_GE(master_ = ::posix_openpt(O_RDWR | O_NOCTTY), 0);
    ASSERT_EQ(::grantpt(master_) | ::unlockpt(master_), 0);
    name_ = ::ptsname(master_);
    slave_ = ::open(name_.c_str(), O_RDWR | O_NOCTTY);
    ASSERT_GE(slave_, 0);
  }
  void TearDown() override {
    ::close(slave_);
    ::close(master_);
  }
  int master_ = -1;
  int slave_ = -1;
  std::string name_;
};

TEST_F(PortCheckTest, APortThatNobodyHasLockedIsFree) {
  EXPECT_EQ(check_port(name_).state, State::kReady);
  EXPECT_EQ(check_port(name_).text, name_ + " is free");
}

TEST_F(PortCheckTest, ABusyPortNamesItsHolder) {
  ASSERT_EQ(::flock(slave_, LOCK_EX | LOCK_NB), 0);
  const PortCheck busy = check_port(name_);
  EXPECT_EQ(busy.state, State::kBusy);
  EXPECT_NE(busy.text.find("(pid " + std::to_string(::getpid()) + ", running for "), std::string::npos) << busy.text;
  EXPECT_EQ(::flock(slave_, LOCK_EX | LOCK_NB), 0) << "whoever has it keeps it";
}

TEST_F(PortCheckTest, WhatIsNoTerminalIsNoPort) {
  const test::TemporaryFolder folder;
  EXPECT_EQ(check_port(folder.write("file", "x")).state, State::kNotSerial);
  EXPECT_EQ(check_port("/dev/null").state, State::kNotSerial);
  EXPECT_EQ(check_port(folder.path() / "absent").state, State::kMissing);
}

TEST_F(PortCheckTest, APortThatThisUserMayNotOpenIsForbidden) {
  if (::geteuid() == 0) GTEST_SKIP() << "root may open every port";
  ASSERT_EQ(::chmod(name_.c_str(), 0), 0);
  EXPECT_EQ(check_port(name_).state, State::kForbidden);
}

}  // namespace
}  // namespace deltamap::drivers::port
