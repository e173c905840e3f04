// SPDX-License-Identifier: Apache-2.0
// Keeps the log readable while something comes and goes many times a second: of lines that differ in their numbers
// alone one a minute is written. When the minute is over, the newest of those held back follows, with its age and their
// count.
#pragma once

#include <chrono>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "daemon/telemetry/log_level.hpp"

namespace deltamap::daemon {

struct LeveledLine {
  LogLevel level = LogLevel::kInfo;
  std::string text;
  friend bool operator==(const LeveledLine&, const LeveledLine&) = default;
};

class LogThrottle {
 public:
  using Clock = std::chrono::steady_clock;

  /// The line where it is to be written now. What an operator asked for, what became of a Δ-phase, and what is told of
  /// a thing, a bay or an incident always are: each of these stands for itself, and two may differ in a number alone.
  [[nodiscard]] std::optional<LeveledLine> take(LeveledLine line, Clock::time_point now);
  /// About once a second: what was held back and is due.
  [[nodiscard]] std::vector<LeveledLine> due(Clock::time_point now);
  /// At the end: everything that was held back.
  [[nodiscard]] std::vector<LeveledLine> rest(Clock::time_point now);

 private:
  struct Kind {
    Clock::time_point written;
    std::optional<LeveledLine> held{};  ///< the newest
    Clock::time_point held_since{};
    std::uint64_t held_count = 0;
    [[nodiscard]] LeveledLine told(Clock::time_point now);
  };
  std::map<std::string, Kind> kinds_;  // by their text without numbers; of the last minute
};

}  // namespace deltamap::daemon
