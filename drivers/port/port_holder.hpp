// SPDX-License-Identifier: Apache-2.0
// Who else uses a serial device: processes that have it open, and lock files that programs such as minicom leave in
// /var/lock. Looks only; nothing is ever removed.
#pragma once

#include <sys/types.h>

#include <optional>
#include <string>
#include <vector>

namespace deltamap::drivers::port {

struct PortHolder {
  pid_t pid = 0;
  std::string name;
  double age_s = 0.0;  ///< since the process began

  /// "'minicom' (pid 812, running for 3 h)"
  [[nodiscard]] std::string told() const;
};

struct PortHolders {
  std::vector<PortHolder> seen;
  bool saw_all = true;  ///< false: processes of other users hide what they have open

  /// "'minicom' (pid 812, running for 3 h) has it open", or that it could not be seen.
  [[nodiscard]] std::string told() const;
};

/// The processes that have the device at `path` open; one descriptor of this process does not count.
[[nodiscard]] PortHolders holders_of(const std::string& path, int except_descriptor = -1);

/// Those of them that have locked it (flock), where any has: a pseudo-terminal's other end keeps it open as well.
[[nodiscard]] PortHolders lockers_or_holders_of(const std::string& path, int except_descriptor = -1);
/// By the kernel's table of locks.
[[nodiscard]] std::optional<PortHolder> locker_of(const std::string& path);

inline constexpr const char* kLockFolder = "/var/lock";
/// The living process that a lock file LCK..NAME in `lock_folder` names, NAME as in `path` or where its link leads.
[[nodiscard]] std::optional<PortHolder> lock_file_holder(const std::string& path, const std::string& lock_folder);

}  // namespace deltamap::drivers::port
