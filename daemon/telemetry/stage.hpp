// SPDX-License-Identifier: Apache-2.0
// Runs one stage of the pipeline on a thread of its own. An exception that leaves the stage is logged and ends the
// process in order (systemd starts it again); no exception crosses a thread.
#pragma once

#include <atomic>
#include <cstdint>
#include <ctime>
#include <functional>
#include <optional>
#include <string>
#include <thread>

namespace deltamap::daemon {

/// CPU time that the calling thread, or the whole process, has used.
[[nodiscard]] double thread_cpu_s();
[[nodiscard]] double process_cpu_s();

/// Shows that a stage moves: it beats whenever it looks for work, at least once a second. One that hangs, at work or
/// while it waits, beats no more, and starves the watchdog.
class Pulse {
 public:
  Pulse() { beat(); }
  void beat();
  /// Any thread: since the last beat, s.
  [[nodiscard]] double silence_s() const;

 private:
  std::atomic<std::int64_t> beat_ns_{0};  // steady clock
};

class Stage {
 public:
  struct Options {
    std::string name;  ///< at most 15 characters: the thread's name too
    int niceness = 0;  ///< 0 to 19: how far behind the other threads
  };
  /// Begins at once. `on_failure` is called from the stage's thread with one line.
  Stage(Options options, std::function<void()> body, std::function<void(const std::string&)> on_failure);

  void join();
  /// After join().
  [[nodiscard]] double cpu_s() const { return cpu_s_; }
  /// Any thread: so far; nothing before the stage's thread runs, and once it has ended.
  [[nodiscard]] std::optional<double> cpu_now_s() const;

 private:
  std::atomic<clockid_t> clock_{0};  // of the thread's CPU time, while it runs; 0: it does not
  double cpu_s_ = 0.0;
  std::jthread thread_;
};

}  // namespace deltamap::daemon
