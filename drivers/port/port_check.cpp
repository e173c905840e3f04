// SPDX-License-Identifier: Apache-2.0
#include "drivers/port/port_check.hpp"

#include <sys/stat.h>
#include <sys/sysmacros.h>
#include <unistd.h>

#include <cerrno>
#include <filesystem>

#include "core/files/access.hpp"
#include "drivers/port/port_holder.hpp"
#include "drivers/port/terminal.hpp"

namespace deltamap::drivers::port {
namespace {

namespace fs = std::filesystem;

/// True for a tty: by its entry in /sys/dev/char, or by its number for a pseudo-terminal, which has no entry there.
bool is_serial(const struct stat& device) {
  if (!S_ISCHR(device.st_mode)) return false;
  if (is_pseudo_terminal(device.st_rdev)) return true;
  std::error_code error;
  const auto number = std::to_string(major(device.st_rdev)) + ":" + std::to_string(minor(device.st_rdev));
  const fs::path subsystem = fs::read_symlink("/sys/dev/char/" + number + "/subsystem", error);
  return error ? !fs::exists("/sys/dev/char", error) : subsystem.filename() == "tty";
}

/// Who has the port, in words; empty where nobody has. Of a pseudo-terminal only locks count: the program at its other
/// end keeps the device open, too.
std::string busy(const std::string& path, dev_t number) {
  if (const auto holder = lock_file_holder(path, kLockFolder)) {
    return holder->told() + " has a lock file in " + kLockFolder;
  }
  if (const auto holder = locker_of(path)) return holder->told() + " has it open";
  if (is_pseudo_terminal(number)) return "";
  const PortHolders holders = holders_of(path);
  return holders.seen.empty() ? "" : holders.told();
}

}  // namespace

PortCheck check_port(const std::string& path) {
  using State = PortCheck::State;
  struct stat device {};
  if (::stat(path.c_str(), &device) != 0) {
    const int error = errno;
    return {error == EACCES ? State::kForbidden : State::kMissing, path + " " + why_not_opened(path, error)};
  }
  if (!is_serial(device)) return {State::kNotSerial, path + " is not a serial port"};
  if (!may_access(path, R_OK | W_OK)) return {State::kForbidden, path + " " + why_not_opened(path, EACCES)};
  if (const std::string why = busy(path, device.st_rdev); !why.empty()) {
    return {State::kBusy, path + " is busy: " + why};
  }
  return {State::kReady, path + " is free"};
}

}  // namespace deltamap::drivers::port
