// SPDX-License-Identifier: Apache-2.0
// A number and what it counts, for lines that people read.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

namespace deltamap {

/// "1 scan", "2 scans", "0 scans"; `several` where that is not `one` with an s.
[[nodiscard]] inline std::string counted(std::uint64_t count, std::string_view one, std::string_view several = {}) {
  std::string text = std::to_string(count) + " ";
  if (count == 1) return text.append(one);
  return several.empty() ? text.append(one).append("s") : text.append(several);
}

}  // namespace deltamap
