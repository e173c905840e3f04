// SPDX-License-Identifier: Apache-2.0
// A number as people write it: the fewest digits that read back as the same double. 0.05, not 0.050000000000000003.
#pragma once

#include <charconv>
#include <string>

namespace deltamap {

[[nodiscard]] inline std::string shortest_text(double value) {
  char buffer[32];
  const auto [end, error] = std::to_chars(buffer, buffer + sizeof buffer, value);
  return error == std::errc{} ? std::string(buffer, end) : std::string{};
}

}  // namespace deltamap
