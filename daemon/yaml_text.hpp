// SPDX-License-Identifier: Apache-2.0
// Looks at the text of a settings file before it is read as YAML. Finds what a YAML reader accepts in silence (a quote
// that is not closed swallows the lines below it; a second document is not read) and what it calls by a misleading
// name (a tab, a binary file).
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace deltamap::daemon {

struct TextProblem {
  int line = 1;    ///< from 1
  int column = 1;  ///< in bytes, from 1
  std::string what;
};

/// In the order of the text; empty where it may be read as YAML. Stricter than YAML: a value ends on its line.
[[nodiscard]] std::vector<TextProblem> problems_of_text(std::string_view yaml);

}  // namespace deltamap::daemon
