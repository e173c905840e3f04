// SPDX-License-Identifier: Apache-2.0
#include "tool/ctl/status_watch.hpp"

#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <cmath>
#include <csignal>
#include <optional>
#include <ostream>
#include <stdexcept>
#include <string>

#include "daemon/control/request.hpp"
#include "daemon/system/terminal_width.hpp"
#include "tool/ctl/daemon_reply.hpp"

namespace deltamap::tool {
namespace {

using Clock = std::chrono::steady_clock;

/// While it lives, Ctrl-C is waited for and does not end the program.
class StopWait {
 public:
  StopWait() {
    sigemptyset(&signals_);
    for (const int signal : {SIGINT, SIGTERM}) sigaddset(&signals_, signal);
    (void)::pthread_sigmask(SIG_BLOCK, &signals_, &before_);
  }
  ~StopWait() { (void)::pthread_sigmask(SIG_SETMASK, &before_, nullptr); }
  StopWait(const StopWait&) = delete;
  StopWait& operator=(const StopWait&) = delete;

  /// True as soon as a signal has come; false after that time.
  [[nodiscard]] bool within(double time_s) const {
    const auto until = Clock::now() + std::chrono::duration<double>(time_s);
    for (;;) {
      const double left_s = std::max(0.0, std::chrono::duration<double>(until - Clock::now()).count());
      const timespec left{static_cast<time_t>(left_s), static_cast<long>(1e9 * (left_s - std::floor(left_s)))};
      if (::sigtimedwait(&signals_, nullptr, &left) > 0) return true;
      if (errno != EINTR) return false;
    }
  }

 private:
  sigset_t signals_{};
  sigset_t before_{};
};

class StatusWatch {
 public:
  StatusWatch(const WatchOptions& options, std::ostream& out, std::ostream& err)
      : options_{options}, out_{out}, err_{err} {}

  void look() {
    std::string absence;
    try {
      const DaemonReply reply = reply_to({}, options_.socket);
      if (!reply.ok) throw std::runtime_error(options_.socket.string() + ": " + reply.words);
      tell_return(reply.since_start_s);
      show(options_.as_json ? reply.line : reply.status_line);
    } catch (const std::runtime_error& error) {
      if (!has_answered_) throw;
      absence = error.what();
    }
    if (!absence.empty()) tell_absence(absence);
    if (!out_.flush()) throw std::runtime_error("standard output: cannot be written");
  }
  void end() {
    if (options_.on_terminal && !options_.as_json) out_ << '\n' << std::flush;
  }

 private:
  void tell_return(double since_start_s) {
    const bool is_another = has_answered_ && since_start_s < since_start_s_;
    if (gone_since_ || is_another) tell(is_another ? "the daemon has been started again" : "the daemon answers again");
    gone_since_.reset();
    has_answered_ = true;
    since_start_s_ = since_start_s;
  }

  void tell_absence(const std::string& why) {
    if (!gone_since_) {
      gone_since_ = Clock::now();
      tell(why + "; waits for it");
    }
    if (std::chrono::duration<double>(Clock::now() - *gone_since_).count() < options_.patience_s) return;
    throw std::runtime_error(why + ", for " + std::to_string(std::lround(options_.patience_s)) + " s");
  }

  /// What is no status.
  void tell(const std::string& what) {
    if (options_.as_json) {
      out_ << daemon::control::error_line(what) << '\n';
    } else {
      err_ << (options_.on_terminal ? "\r\033[K" : "") << "deltamap: " << what << std::endl;
    }
  }

  void show(const std::string& line) {
    if (options_.on_terminal && !options_.as_json) {
      out_ << "\r\033[K" << daemon::fitted_to_terminal(line, STDOUT_FILENO);
    } else {
      out_ << line << '\n';
    }
  }

  const WatchOptions& options_;
  std::ostream& out_;
  std::ostream& err_;
  bool has_answered_ = false;
  double since_start_s_ = 0.0;
  std::optional<Clock::time_point> gone_since_;
};

}  // namespace

void watch_status(const WatchOptions& options, std::ostream& out, std::ostream& err) {
  const StopWait stop;
  StatusWatch watch{options, out, err};
  do {
    watch.look();
  } while (!stop.within(options.period_s));
  watch.end();
}

}  // namespace deltamap::tool
