// SPDX-License-Identifier: Apache-2.0
// A line or a cell of a table without the blanks around it.
#pragma once

#include <algorithm>
#include <string>

namespace deltamap {

/// Without spaces, tabs and carriage returns at its ends.
[[nodiscard]] inline std::string trimmed(std::string text) {
  constexpr const char* kBlank = " \t\r";
  text.erase(0, std::min(text.find_first_not_of(kBlank), text.size()));
  text.erase(text.find_last_not_of(kBlank) + 1);
  return text;
}

}  // namespace deltamap
