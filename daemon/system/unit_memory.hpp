// SPDX-License-Identifier: Apache-2.0
// How much memory the installed service may take, for a check that runs outside of it.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

namespace deltamap::daemon {

struct UnitMemory {
  std::uint64_t most_bytes = 0;
  std::string of{};  ///< who says so: "MemoryMax of deltamap.service"
};

/// Asks systemd. Nothing where the unit is not limited; what the delivered one has where there is no systemd, or no
/// unit yet.
[[nodiscard]] std::optional<UnitMemory> unit_memory();
/// From what `systemctl show` prints of LoadState and MemoryMax.
[[nodiscard]] std::optional<UnitMemory> unit_memory_of(const std::string& properties);

}  // namespace deltamap::daemon
