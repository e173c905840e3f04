// SPDX-License-Identifier: Apache-2.0
#include "daemon/system/terminal_width.hpp"

#include <gtest/gtest.h>
#include <pty.h>
#include <unistd.h>

namespace deltamap::daemon {
namespace {

class TerminalWidth : public testing::Test {
 protected:
  TerminalWidth() { EXPECT_EQ(::openpty(&master_, &terminal_, nullptr, nullptr, nullptr), 0); }
  ~TerminalWidth() override {
    ::close(master_);
    ::close(terminal_);
  }
  std::string fitted(const std::string& line, unsigned short columns) const {
    winsize size{};
    size.ws_col = columns;
    EXPECT_EQ(::ioctl(terminal_, TIOCSWINSZ, &size), 0);
    return fitted_to_terminal(line, terminal_);
  }

 private:
  int master_ = -1;
  int terminal_ = -1;
};

TEST_F(TerminalWidth, CutsALineThatWouldScroll) {
  const std::string line(170, 'x');
  EXPECT_EQ(fitted(line, 80).size(), 79U);
  EXPECT_EQ(fitted(line, 171), line);
  EXPECT_EQ(fitted("short", 80), "short");
}

TEST_F(TerminalWidth, CutsNoCharacterInTwo) {
  EXPECT_EQ(fitted("M\u2080 \u0394\u0394\u0394", 6), "M\u2080 \u0394\u0394");
}

TEST_F(TerminalWidth, LeavesALineWholeWhereNoWidthIsKnown) {
  const std::string line(170, 'x');
  EXPECT_EQ(fitted(line, 0), line);
  EXPECT_EQ(fitted_to_terminal(line, -1), line);
}

}  // namespace
}  // namespace deltamap::daemon
