// SPDX-License-Identifier: Apache-2.0
#include "simulation/devices/pseudo_terminal.hpp"

#include <fcntl.h>
#include <stdlib.h>
#include <termios.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstring>
#include <stdexcept>
#include <utility>

namespace deltamap::simulation::devices {
namespace {

[[noreturn]] void refuse(const std::filesystem::path& link, const std::string& why) {
  throw std::runtime_error(link.string() + ": " + why);
}

/// Bytes as they are: no echo, no line editing, no translation of line ends.
void make_raw(int slave) {
  termios settings{};
  if (::tcgetattr(slave, &settings) != 0) return;
  ::cfmakeraw(&settings);
  ::tcsetattr(slave, TCSANOW, &settings);
}

/// A link of a simulator that was killed leads nowhere, or to whoever was given the number of its pseudo-terminal next.
bool is_left_over(const std::filesystem::path& link) {
  std::error_code error;
  if (!std::filesystem::is_symlink(link, error)) return false;
  const bool leads_nowhere = !std::filesystem::exists(link, error);
  return leads_nowhere || std::filesystem::read_symlink(link, error).parent_path() == "/dev/pts";
}

void place_link(const std::filesystem::path& target, const std::filesystem::path& link) {
  std::error_code error;
  if (is_left_over(link)) std::filesystem::remove(link, error);
  std::filesystem::create_symlink(target, link, error);
  if (error) refuse(link, "the link cannot be placed: " + error.message());
}

}  // namespace

PseudoTerminal::PseudoTerminal(std::filesystem::path link) : link_{std::move(link)} {
  master_ = ::posix_openpt(O_RDWR | O_NOCTTY | O_NONBLOCK | O_CLOEXEC);
  std::array<char, 128> name{};
  if (master_ < 0 || ::grantpt(master_) != 0 || ::unlockpt(master_) != 0 ||
      ::ptsname_r(master_, name.data(), name.size()) != 0) {
    const std::string why = std::strerror(errno);
    if (master_ >= 0) ::close(master_);
    refuse(link_, "no pseudo-terminal: " + why);
  }
  // Opened and closed once: from now on the master's end tells by a hang-up that nobody listens.
  const int slave = ::open(name.data(), O_RDWR | O_NOCTTY | O_CLOEXEC);
  if (slave >= 0) {
    make_raw(slave);
    ::close(slave);
  }
  try {
    place_link(name.data(), link_);
  } catch (...) {
    ::close(master_);
    throw;
  }
}

PseudoTerminal::~PseudoTerminal() {
  std::error_code ignored;
  std::filesystem::remove(link_, ignored);
  ::close(master_);
}

bool PseudoTerminal::is_open_elsewhere() const {
  pollfd state{master_, POLLOUT, 0};
  return ::poll(&state, 1, 0) >= 0 && (state.revents & POLLHUP) == 0;
}

unsigned PseudoTerminal::baud() const {
  termios settings{};
  if (::tcgetattr(master_, &settings) != 0) return 0;
  switch (::cfgetospeed(&settings)) {
    case B9600:
      return 9600;
    case B19200:
      return 19200;
    case B38400:
      return 38400;
    case B57600:
      return 57600;
    case B115200:
      return 115200;
    case B500000:
      return 500000;
    default:
      return 0;
  }
}

std::vector<std::uint8_t> PseudoTerminal::read() {
  std::vector<std::uint8_t> bytes;
  std::array<std::uint8_t, 512> chunk;
  for (;;) {
    const ssize_t count = ::read(master_, chunk.data(), chunk.size());
    if (count < 0 && errno == EINTR) continue;
    if (count <= 0) return bytes;  // nothing now, or nobody there
    bytes.insert(bytes.end(), chunk.begin(), chunk.begin() + count);
  }
}

void PseudoTerminal::write(std::span<const std::uint8_t> bytes) {
  if (!is_open_elsewhere()) return;
  while (!bytes.empty()) {
    const ssize_t count = ::write(master_, bytes.data(), bytes.size());
    if (count < 0 && errno == EINTR) continue;
    if (count <= 0) return;
    bytes = bytes.subspan(static_cast<std::size_t>(count));
  }
}

/// A hang-up would wake at once, again and again.
void PseudoTerminal::watch(std::vector<pollfd>& watched) const {
  if (is_open_elsewhere()) watched.push_back({master_, POLLIN, 0});
}

}  // namespace deltamap::simulation::devices
