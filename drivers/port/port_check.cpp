// SPDX-License-Identifier: Apache-2.0
#include "drivers/port/port_check.hpp"

#include <sys/stat.h>
#include <sys/sysmacros.h>
#include <unistd.h>

#include <cerrno>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <sstream>

#include "drivers/port/terminal.hpp"

namespace deltamap::drivers::port {
namespace {

namespace fs = std::filesystem;

/// The kernel lists each device by its number; pseudo-terminals (kernel's devices.txt) are not among them.
bool is_serial(const struct stat& device) {
  if (!S_ISCHR(device.st_mode)) return false;
  if (is_pseudo_terminal(device.st_rdev)) return true;
  std::error_code error;
  const auto number = std::to_string(major(device.st_rdev)) + ":" + std::to_string(minor(device.st_rdev));
  const fs::path subsystem = fs::read_symlink("/sys/dev/char/" + number + "/subsystem", error);
  return error ? !fs::exists("/sys/dev/char", error) : subsystem.filename() == "tty";
}

std::string process_text(const std::string& pid) {
  std::string name;
  std::getline(std::ifstream("/proc/" + pid + "/comm"), name);
  return (name.empty() ? "a process" : name) + " (process " + pid + ")";
}

/// Who has locked it: a pseudo-terminal's other end keeps it open as well, and is no rival.
std::string locking_process(const struct stat& device) {
  std::ifstream locks("/proc/locks");
  for (std::string line; std::getline(locks, line);) {
    std::istringstream words(line);
    std::string number, kind, mode, access, pid, file;
    words >> number >> kind >> mode >> access >> pid >> file;
    const auto colon = file.rfind(':');
    if (kind != "FLOCK" || colon == std::string::npos || file.substr(colon + 1) != std::to_string(device.st_ino))
      continue;
    char* minor_at = nullptr;
    const auto major_number = std::strtoul(file.c_str(), &minor_at, 16);
    const auto minor_number = std::strtoul(minor_at + 1, nullptr, 16);
    if (major_number == major(device.st_dev) && minor_number == minor(device.st_dev)) return process_text(pid);
  }
  return "";
}

bool has_open(const fs::path& process, const struct stat& device) {
  std::error_code error;
  for (fs::directory_iterator file{process / "fd", error}, end; !error && file != end; file.increment(error)) {
    struct stat open_file {};
    if (::stat(file->path().c_str(), &open_file) == 0 && S_ISCHR(open_file.st_mode) &&
        open_file.st_rdev == device.st_rdev)
      return true;
  }
  return false;
}

/// As far as this user may look: root sees every process, others their own.
std::string opening_process(const struct stat& device) {
  std::error_code error;
  for (fs::directory_iterator process{"/proc", error}, end; !error && process != end; process.increment(error)) {
    const std::string pid = process->path().filename();
    if (pid.find_first_not_of("0123456789") != std::string::npos || pid == std::to_string(::getpid())) continue;
    if (has_open(process->path(), device)) return process_text(pid);
  }
  return "";
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
  if (::access(path.c_str(), R_OK | W_OK) != 0) return {State::kForbidden, path + " " + why_not_opened(path, EACCES)};
  std::string holder = locking_process(device);
  if (holder.empty() && !is_pseudo_terminal(device.st_rdev)) holder = opening_process(device);
  if (!holder.empty()) return {State::kBusy, path + " is busy: " + holder + " has it open"};
  return {State::kReady, path + " is free"};
}

}  // namespace deltamap::drivers::port
