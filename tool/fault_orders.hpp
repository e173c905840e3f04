// SPDX-License-Identifier: Apache-2.0
// What `deltamap sim` is told on its standard input while it plays: faults that begin and end.
#pragma once

#include <poll.h>

#include <string>
#include <vector>

#include "simulation/simulation.hpp"

namespace deltamap::tool {

/// Obeys one line (`help` tells which there are) and answers what to say about it, with its line ends.
[[nodiscard]] std::string obeyed(const std::string& line, simulation::Simulation& simulation);

/// The lines of a descriptor that others may share: it is never made non-blocking, and a terminal is read in the
/// foreground alone.
class OrderLines {
 public:
  explicit OrderLines(int descriptor) : descriptor_{descriptor} {}

  /// What has come since the last call; never waits.
  [[nodiscard]] std::vector<std::string> read();
  void watch(std::vector<pollfd>& watched) const;

 private:
  [[nodiscard]] bool may_be_read() const;

  int descriptor_;
  bool is_over_ = false;
  std::string begun_;  // a line without its end
};

}  // namespace deltamap::tool
