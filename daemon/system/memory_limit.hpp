// SPDX-License-Identifier: Apache-2.0
// How much memory this process may take: what the service or container allows it (cgroup v2), and what the machine has.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>

namespace deltamap::daemon {

struct MemoryLimit {
  std::uint64_t most_bytes = UINT64_MAX;  ///< beyond, it is ended
  std::string most_of{};                  ///< who says so: "MemoryMax of /system.slice/deltamap.service"
  bool may_rise = false;                  ///< most_bytes is what is free now: another time it may be more
  std::uint64_t high_bytes = UINT64_MAX;  ///< beyond, it is slowed down
  std::string high_of{};                  ///< who says so
};

/// `root` is where /proc and /sys lie. What cannot be read limits nothing.
[[nodiscard]] MemoryLimit memory_limit(const std::filesystem::path& root = "/");

}  // namespace deltamap::daemon
