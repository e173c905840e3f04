// SPDX-License-Identifier: Apache-2.0
// Shows that a thread with an event loop moves. It takes many small turns: one that hangs shows in that no other comes.
#pragma once

#include <atomic>
#include <chrono>

namespace deltamap::daemon {

class LoopPulse {
 public:
  /// Any one thread, now and then: for how long the loop owes an answer to an earlier call, s. `post(work)` hands it
  /// work.
  template <typename Post>
  [[nodiscard]] double silence_s(const Post& post) {
    const Clock::time_point now = Clock::now();
    if (owes_) return std::chrono::duration<double>(now - asked_).count();
    asked_ = now;
    owes_ = true;
    post([this] { owes_ = false; });
    return 0.0;
  }

 private:
  using Clock = std::chrono::steady_clock;
  std::atomic<bool> owes_{false};
  Clock::time_point asked_{};  // of the thread that asks
};

}  // namespace deltamap::daemon
