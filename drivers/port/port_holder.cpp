// SPDX-License-Identifier: Apache-2.0
#include "drivers/port/port_holder.hpp"

#include <signal.h>
#include <sys/stat.h>
#include <sys/sysmacros.h>
#include <time.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <charconv>
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <sstream>

namespace deltamap::drivers::port {
namespace {

namespace fs = std::filesystem;

std::optional<pid_t> number_in(const std::string& text) {
  const auto begin = std::find_if(text.begin(), text.end(), [](char c) { return c != ' '; });
  pid_t number = 0;
  const char* const first = text.data() + (begin - text.begin());
  const auto [end, error] = std::from_chars(first, text.data() + text.size(), number);
  const bool is_number = error == std::errc{} && (end == text.data() + text.size() || *end == '\n' || *end == ' ');
  return is_number ? std::optional{number} : std::nullopt;
}

std::string text_of(const fs::path& file) {
  std::ifstream in{file, std::ios::binary};
  return {std::istreambuf_iterator<char>{in}, {}};
}

/// The process's name and age from /proc/PID/stat: the name in brackets may hold anything, and the 20th field behind it
/// is the start in ticks since boot.
PortHolder holder_of(pid_t pid) {
  PortHolder holder{pid, "?", 0.0};
  const std::string stat = text_of("/proc/" + std::to_string(pid) + "/stat");
  const std::size_t open = stat.find('(');
  const std::size_t close = stat.rfind(')');
  if (open == std::string::npos || close == std::string::npos) return holder;
  holder.name = stat.substr(open + 1, close - open - 1);
  std::istringstream fields{stat.substr(close + 1)};
  std::string field;
  constexpr int kStart = 20;
  for (int i = 0; i < kStart; ++i) fields >> field;
  timespec since_boot{};
  ::clock_gettime(CLOCK_BOOTTIME, &since_boot);
  const double started_s = std::strtod(field.c_str(), nullptr) / static_cast<double>(::sysconf(_SC_CLK_TCK));
  holder.age_s = std::max(0.0, static_cast<double>(since_boot.tv_sec) - started_s);
  return holder;
}

/// Whether the process has the device open; nullopt where this user may not see its descriptors.
std::optional<bool> has_open(pid_t pid, dev_t device, int except_descriptor) {
  std::error_code error;
  fs::directory_iterator descriptors{"/proc/" + std::to_string(pid) + "/fd", error};
  if (error) return error.value() == EACCES || error.value() == EPERM ? std::nullopt : std::optional{false};
  for (; descriptors != fs::directory_iterator{}; descriptors.increment(error)) {
    if (error) return false;  // the process has ended
    const std::optional<pid_t> number = number_in(descriptors->path().filename().string());
    if (pid == ::getpid() && number == except_descriptor) continue;
    struct stat status {};
    if (::stat(descriptors->path().c_str(), &status) != 0) continue;
    if (S_ISCHR(status.st_mode) && status.st_rdev == device) return true;
  }
  return false;
}

/// Rounded down so coarsely that a line about a port that stays busy is the same line at most tries.
std::string told_age(double age_s) {
  struct Step {
    double begin_s;
    const char* text;
  };
  constexpr double kDay_s = 86400.0;
  constexpr double kHour_s = 3600.0;
  if (age_s >= 2.0 * kDay_s) return std::to_string(static_cast<long>(age_s / kDay_s)) + " days";
  if (age_s >= 2.0 * kHour_s) return std::to_string(static_cast<long>(age_s / kHour_s)) + " h";
  constexpr auto kSteps = std::to_array<Step>({{kHour_s, "1 h"},
                                               {1800.0, "30 min"},
                                               {600.0, "10 min"},
                                               {120.0, "2 min"},
                                               {30.0, "30 s"},
                                               {10.0, "10 s"},
                                               {2.0, "2 s"}});
  const auto* step = std::find_if(kSteps.begin(), kSteps.end(), [&](const Step& s) { return age_s >= s.begin_s; });
  return step != kSteps.end() ? step->text : "0 s";
}

}  // namespace

std::string PortHolder::told() const {
  return "'" + name + "' (pid " + std::to_string(pid) + ", running for " + told_age(age_s) + ")";
}

std::string PortHolders::told() const {
  std::string text;
  for (const PortHolder& holder : seen) text += (text.empty() ? "" : ", ") + holder.told();
  if (!text.empty()) return text + (seen.size() > 1 ? " have it open" : " has it open");
  return saw_all ? "another program has locked it" : "a program of another user has it open";
}

PortHolders holders_of(const std::string& path, int except_descriptor) {
  PortHolders holders;
  struct stat device {};
  if (::stat(path.c_str(), &device) != 0 || !S_ISCHR(device.st_mode)) return holders;
  std::error_code error;
  for (fs::directory_iterator entry{"/proc", error}; !error && entry != fs::directory_iterator{};
       entry.increment(error)) {
    const std::optional<pid_t> pid = number_in(entry->path().filename().string());
    if (!pid) continue;
    const std::optional<bool> holds = has_open(*pid, device.st_rdev, except_descriptor);
    if (!holds) holders.saw_all = false;
    if (holds == true) holders.seen.push_back(holder_of(*pid));
  }
  return holders;
}

std::optional<PortHolder> locker_of(const std::string& path) {
  struct stat device {};
  if (::stat(path.c_str(), &device) != 0) return std::nullopt;
  std::ifstream locks{"/proc/locks"};
  for (std::string line; std::getline(locks, line);) {
    std::istringstream words{line};
    std::string number, kind, mode, access, pid, file;
    words >> number >> kind >> mode >> access >> pid >> file;
    const auto colon = file.rfind(':');
    const bool is_same_node = colon != std::string::npos && file.substr(colon + 1) == std::to_string(device.st_ino);
    if (kind != "FLOCK" || !is_same_node) continue;
    char* minor_at = nullptr;
    const auto major_number = std::strtoul(file.c_str(), &minor_at, 16);
    const auto minor_number = std::strtoul(minor_at + 1, nullptr, 16);
    if (major_number != major(device.st_dev) || minor_number != minor(device.st_dev)) continue;
    if (const auto holder = number_in(pid)) return holder_of(*holder);
  }
  return std::nullopt;
}

PortHolders lockers_or_holders_of(const std::string& path, int except_descriptor) {
  if (const auto locker = locker_of(path)) return {{*locker}, true};
  return holders_of(path, except_descriptor);
}

std::optional<PortHolder> lock_file_holder(const std::string& path, const std::string& lock_folder) {
  std::error_code error;
  for (const fs::path& device : {fs::path{path}, fs::weakly_canonical(path, error)}) {
    const std::string content = text_of(fs::path{lock_folder} / ("LCK.." + device.filename().string()));
    std::optional<pid_t> pid = number_in(content);
    if (!pid && content.size() == sizeof(pid_t)) {  // some programs write the number in binary
      pid.emplace();
      std::memcpy(&*pid, content.data(), sizeof(pid_t));
    }
    const bool is_alive = pid && *pid > 0 && *pid != ::getpid() && (::kill(*pid, 0) == 0 || errno == EPERM);
    if (is_alive) return holder_of(*pid);
  }
  return std::nullopt;
}

}  // namespace deltamap::drivers::port
