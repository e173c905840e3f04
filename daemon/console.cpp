// SPDX-License-Identifier: Apache-2.0
#include "daemon/console.hpp"

#include <poll.h>
#include <spdlog/spdlog.h>
#include <unistd.h>

#include <iostream>
#include <utility>

#include "core/counted.hpp"
#include "daemon/system/system_journal.hpp"
#include "daemon/system/terminal_width.hpp"

namespace deltamap::daemon {
namespace {

constexpr int kQuietLogPeriod_s = 60;  // between status lines at info level without a terminal; others are debug

spdlog::level::level_enum spdlog_level_of(LogLevel level) {
  switch (level) {
    case LogLevel::kTrace:
      return spdlog::level::trace;
    case LogLevel::kDebug:
      return spdlog::level::debug;
    case LogLevel::kInfo:
      return spdlog::level::info;
    case LogLevel::kWarn:
      return spdlog::level::warn;
    case LogLevel::kError:
      break;
  }
  return spdlog::level::err;
}

}  // namespace

Console::Console() : on_terminal_{::isatty(STDERR_FILENO) != 0}, in_journal_{system_journal::is_behind_stderr()} {}

void Console::set_level(LogLevel level) { spdlog::set_level(spdlog_level_of(level)); }

void Console::write(const LeveledLine& line) {
  const auto level = spdlog_level_of(line.level);
  if (!spdlog::should_log(level)) return;
  if (in_journal_ && system_journal::write(line.level, line.text)) return;
  if (!is_read()) {
    ++lost_;
    return;
  }
  if (const std::uint64_t lost = std::exchange(lost_, 0); lost > 0) {
    write(
        {LogLevel::kWarn, counted(lost, "line of this log is", "lines of this log are") + " lost: nobody has read it"});
    return write(line);
  }
  if (on_terminal_) std::cerr << "\r\033[K" << std::flush;
  spdlog::log(level, "{}", line.text);
}

/// True where standard error takes a line at once: a pipe then has room for PIPE_BUF bytes.
bool Console::is_read() {
  pollfd out{STDERR_FILENO, POLLOUT, 0};
  return ::poll(&out, 1, 0) != 0;  // a broken pipe counts as read: writing to it reports the error
}

void Console::log(LogLevel level, const std::string& line) {
  const std::scoped_lock lock{mutex_};
  const auto now_due = throttle_.take({level, line}, LogThrottle::Clock::now());
  if (now_due) write(*now_due);
}

void Console::show(const std::string& status) {
  const std::scoped_lock lock{mutex_};
  for (const LeveledLine& line : throttle_.due(LogThrottle::Clock::now())) write(line);
  if (on_terminal_) {
    if (is_read()) std::cerr << "\r\033[K" << fitted_to_terminal(status, STDERR_FILENO) << std::flush;
  } else {
    write({seconds_++ % kQuietLogPeriod_s == 0 ? LogLevel::kInfo : LogLevel::kDebug, status});
  }
}

void Console::end() {
  const std::scoped_lock lock{mutex_};
  if (on_terminal_ && is_read()) std::cerr << '\n';
  for (const LeveledLine& line : throttle_.rest(LogThrottle::Clock::now())) write(line);
}

}  // namespace deltamap::daemon
