// SPDX-License-Identifier: Apache-2.0
// A progress bar on standard error: on a terminal only, nothing in a pipe.
#pragma once

#include <cstdint>
#include <string>

namespace deltamap::tool {

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
  bool on_terminal_;
};

}  // namespace deltamap::tool
