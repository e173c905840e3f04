// SPDX-License-Identifier: Apache-2.0
// What a recording lacks against how it was written.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "drivers/port/log_cut.hpp"

namespace deltamap::drivers::port {

struct LogFaults {
  std::optional<LogCut> cut;        ///< nothing after it can be read
  std::vector<std::string> doubts;  ///< a line each, with file, place and what to do
  bool lacks_records = false;       ///< bytes or notes are missing before the end
  bool is_unchecked = false;        ///< none are known to be missing, and nothing would tell
  bool lacks_end = false;           ///< the last ones are missing, or may be

  /// All that a person must be told.
  [[nodiscard]] std::vector<std::string> lines() const {
    std::vector<std::string> all = doubts;
    if (cut) all.insert(all.begin(), cut->text);
    return all;
  }
};

}  // namespace deltamap::drivers::port
