// SPDX-License-Identifier: Apache-2.0
// A short line for the log, on its way to the thread that writes it.
#pragma once

#include <string>

namespace deltamap::daemon {

struct LogLine {
  std::string text;         ///< empty: nothing to say
  bool is_warning = false;  ///< what is degraded, or needs a person
  friend bool operator==(const LogLine&, const LogLine&) = default;
};

}  // namespace deltamap::daemon
