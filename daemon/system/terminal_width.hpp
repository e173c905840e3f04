// SPDX-License-Identifier: Apache-2.0
// How much of a line fits a terminal: one that is longer could not be written over.
#pragma once

#include <sys/ioctl.h>

#include <cstddef>
#include <string>

namespace deltamap::daemon {

/// Cut by whole characters (UTF-8) to one column less than the terminal is wide; whole where it says no width, or is
/// none.
[[nodiscard]] inline std::string fitted_to_terminal(const std::string& line, int terminal) {
  winsize size{};
  if (::ioctl(terminal, TIOCGWINSZ, &size) != 0 || size.ws_col < 2) return line;
  const auto begins_character = [](char byte) { return (static_cast<unsigned char>(byte) & 0xc0U) != 0x80U; };
  std::size_t columns = 0;
  for (std::size_t at = 0; at < line.size(); ++at) {
    if (begins_character(line[at]) && ++columns == size.ws_col) return line.substr(0, at);
  }
  return line;
}

}  // namespace deltamap::daemon
