// SPDX-License-Identifier: Apache-2.0
// A progress bar on standard error, with the time that is left where that is long: on a terminal only, nothing in a
// pipe.
#pragma once

#include <chrono>
#include <cstdint>
#include <string>

namespace deltamap::tool {

/// "40 s left", "3 min left", "2.1 h left" after `passed_s` seconds for a share in (0, 1]; empty where less than five
/// seconds are, or too little is done to say.
[[nodiscard]] std::string time_left(double passed_s, double share);

class Progress {
 public:
  /// `what` stands before the bar; `total` is the amount of work in any unit (0: unknown, no bar).
  Progress(std::string what, std::uint64_t total);
  /// Wipes the bar, so that the next line of text starts clean.
  ~Progress();
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;

  /// Draws only where the bar or its percentage changes: cheap to call often.
  void show(std::uint64_t done);

 private:
  std::string what_;
  std::uint64_t total_;
  int shown_percent_ = -1;
  std::chrono::steady_clock::time_point began_ = std::chrono::steady_clock::now();
  bool on_terminal_;
};

}  // namespace deltamap::tool
