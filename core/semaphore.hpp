// SPDX-License-Identifier: Apache-2.0
// Wakes a thread that waits for another. In place of std::counting_semaphore: that of GCC 12 gives the processor away
// and takes it again a few times before it sleeps, at each wait (libstdc++ 12, atomic_wait.h), which costs more than
// the messages that it waits for.
#pragma once

#include <semaphore.h>

#include <cerrno>
#include <chrono>
#include <ctime>

namespace deltamap {

class Semaphore {
 public:
  Semaphore() { (void)sem_init(&semaphore_, 0, 0); }
  ~Semaphore() { (void)sem_destroy(&semaphore_); }
  Semaphore(const Semaphore&) = delete;
  Semaphore& operator=(const Semaphore&) = delete;

  /// Any thread; never waits.
  void release() { (void)sem_post(&semaphore_); }
  /// False where nobody has released it.
  [[nodiscard]] bool try_acquire() { return sem_trywait(&semaphore_) == 0; }
  /// Sleeps until somebody does, so long at most by a clock that nobody sets; false where none did.
  template <typename Rep, typename Period>
  [[nodiscard]] bool try_acquire_for(const std::chrono::duration<Rep, Period>& patience) {
    const auto until = std::chrono::steady_clock::now().time_since_epoch() + patience;
    const auto whole = std::chrono::duration_cast<std::chrono::seconds>(until);
    const timespec deadline{
        static_cast<std::time_t>(whole.count()),
        static_cast<long>(std::chrono::duration_cast<std::chrono::nanoseconds>(until - whole).count())};
    int result = 0;
    do {
      result = sem_clockwait(&semaphore_, CLOCK_MONOTONIC, &deadline);
    } while (result != 0 && errno == EINTR);
    return result == 0;
  }

 private:
  sem_t semaphore_;
};

}  // namespace deltamap
