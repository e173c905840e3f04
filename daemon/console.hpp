// SPDX-License-Identifier: Apache-2.0
// Where the daemon's log goes: to systemd's journal with fields, else to standard error; on a terminal the status line
// stands below it. What repeats is held back (log_throttle). A log that nobody reads (a pipe that is full, a terminal
// that is held) holds up no thread: its lines are lost, and counted.
#pragma once

#include <cstdint>
#include <mutex>
#include <string>

#include "daemon/telemetry/log_throttle.hpp"

namespace deltamap::daemon {

class Console {
 public:
  Console();

  /// Any thread.
  void log(LogLevel level, const std::string& line);
  /// Once a second: the status.
  void show(const std::string& status);
  /// After the last show().
  void end();
  static void set_level(LogLevel level);

 private:
  void write(const LeveledLine& line);
  [[nodiscard]] bool is_read();

  std::mutex mutex_;
  LogThrottle throttle_;
  bool on_terminal_;
  bool in_journal_;
  int seconds_ = 0;
  std::uint64_t lost_ = 0;  // lines, since it was read last
};

}  // namespace deltamap::daemon
