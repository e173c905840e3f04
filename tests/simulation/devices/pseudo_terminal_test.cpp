// SPDX-License-Identifier: Apache-2.0
#include "simulation/devices/pseudo_terminal.hpp"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <termios.h>
#include <unistd.h>

#include "tests/support/files/temporary_folder.hpp"

namespace deltamap::simulation::devices {
namespace {

TEST(PseudoTerminal, CarriesBytesBothWaysAndKnowsTheOtherSidesBaud) {
  const test::TemporaryFolder folder;
  PseudoTerminal port{folder.path() / "robot"};
  EXPECT_FALSE(port.is_open_elsewhere());
  port.write(std::vector<std::uint8_t>{0x01});  // nobody listens: lost

  const int program = ::open((folder.path() / "robot").c_str(), O_RDWR | O_NOCTTY | O_NONBLOCK);
  ASSERT_GE(program, 0);
  EXPECT_TRUE(port.is_open_elsewhere());
  termios settings{};
  ASSERT_EQ(::tcgetattr(program, &settings), 0);
  ::cfmakeraw(&settings);
  ::cfsetspeed(&settings, B500000);
  ASSERT_EQ(::tcsetattr(program, TCSANOW, &settings), 0);
  EXPECT_EQ(port.baud(), 500000u);

  const std::vector<std::uint8_t> all{0x00, 0x03, 0x0A, 0x0D, 0x11, 0x13, 0xFF};
  port.write(all);
  std::uint8_t buffer[16];
  ASSERT_EQ(::read(program, buffer, sizeof buffer), static_cast<ssize_t>(all.size())) << "and nothing from before";
  EXPECT_TRUE(std::equal(all.begin(), all.end(), buffer));
  ASSERT_EQ(::write(program, all.data(), all.size()), static_cast<ssize_t>(all.size()));
  EXPECT_EQ(port.read(), all);
  ::close(program);
  EXPECT_FALSE(port.is_open_elsewhere());
}

TEST(PseudoTerminal, RemovesItsLinkAndReplacesOneThatLeadsNowhere) {
  const test::TemporaryFolder folder;
  const auto link = folder.path() / "laser";
  { const PseudoTerminal port{link}; }
  EXPECT_FALSE(std::filesystem::is_symlink(link));
  std::filesystem::create_symlink(folder.path() / "gone", link);
  const PseudoTerminal port{link};
  EXPECT_TRUE(std::filesystem::exists(link));
}

TEST(PseudoTerminal, ReplacesTheLinkOfAKilledSimulatorWhoseNumberIsInUseAgain) {
  const test::TemporaryFolder folder;
  const PseudoTerminal other{folder.path() / "other"};
  const auto number = std::filesystem::read_symlink(folder.path() / "other");
  std::filesystem::create_symlink(number, folder.path() / "robot");
  const PseudoTerminal port{folder.path() / "robot"};
  EXPECT_NE(std::filesystem::read_symlink(folder.path() / "robot"), number);
}

TEST(PseudoTerminal, LeavesOtherFilesAlone) {
  const test::TemporaryFolder folder;
  const auto file = folder.write("robot", "precious");
  EXPECT_THROW(PseudoTerminal{file}, std::runtime_error);
  EXPECT_TRUE(std::filesystem::is_regular_file(file));
}

}  // namespace
}  // namespace deltamap::simulation::devices
