// SPDX-License-Identifier: Apache-2.0
#include "daemon/system/memory_limit.hpp"

#include <fstream>
#include <optional>

namespace deltamap::daemon {
namespace {

namespace fs = std::filesystem;

/// The one number in a file; nothing where it says "max", or cannot be read.
std::optional<std::uint64_t> number_in(const fs::path& file) {
  std::ifstream in(file);
  std::uint64_t number = 0;
  return in >> number ? std::optional{number} : std::nullopt;
}

/// The cgroup of this process ("/system.slice/deltamap.service"), from the line "0::PATH"; nullopt without cgroup v2.
std::optional<fs::path> cgroup_of_this(const fs::path& root) {
  std::ifstream in(root / "proc/self/cgroup");
  for (std::string line; std::getline(in, line);) {
    if (line.starts_with("0::/")) return fs::path(line.substr(3));
  }
  return std::nullopt;
}

std::optional<std::uint64_t> available_bytes(const fs::path& root) {
  std::ifstream in(root / "proc/meminfo");
  std::string name;
  for (std::uint64_t kilobytes = 0; in >> name >> kilobytes; in.ignore(100, '\n')) {
    if (name == "MemAvailable:") return kilobytes * 1024;
  }
  return std::nullopt;
}

/// Lowers a limit, and notes whose it is, to one that was found and is smaller; true where it did.
bool lower(std::uint64_t& bytes, std::string& of, const std::optional<std::uint64_t>& found, const std::string& whose) {
  if (!found || *found >= bytes) return false;
  bytes = *found;
  of = whose;
  return true;
}

}  // namespace

MemoryLimit memory_limit(const fs::path& root) {
  MemoryLimit limit;
  limit.may_rise = lower(limit.most_bytes, limit.most_of, available_bytes(root), "free on this machine");
  const auto own = cgroup_of_this(root);
  if (!own) return limit;
  for (fs::path group = *own;; group = group.parent_path()) {
    const fs::path folder = root / "sys/fs/cgroup" / group.relative_path();
    const std::string name = group.string();
    if (lower(limit.most_bytes, limit.most_of, number_in(folder / "memory.max"), "MemoryMax of " + name)) {
      limit.may_rise = false;
    }
    (void)lower(limit.high_bytes, limit.high_of, number_in(folder / "memory.high"), "MemoryHigh of " + name);
    if (!group.has_relative_path()) return limit;
  }
}

}  // namespace deltamap::daemon
