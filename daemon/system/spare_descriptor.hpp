// SPDX-License-Identifier: Apache-2.0
// A file descriptor that is kept for the moment when the process has no other one left: whoever must open something
// then gives it up first, and takes it back afterwards.
#pragma once

#include <sys/eventfd.h>
#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <cstddef>
#include <mutex>
#include <utility>

namespace deltamap::daemon {

class SpareDescriptor {
 public:
  SpareDescriptor() { hold(); }
  ~SpareDescriptor() { (void)give(); }
  SpareDescriptor(const SpareDescriptor&) = delete;
  SpareDescriptor& operator=(const SpareDescriptor&) = delete;

  /// Whoever keeps a spare one holds this from giving it up until something has it, and from closing something until
  /// the spare one is back: else another of them takes what was meant for him, and he may never have one again.
  [[nodiscard]] static std::unique_lock<std::recursive_mutex> turn() {
    static std::recursive_mutex one_at_a_time;
    return std::unique_lock{one_at_a_time};
  }

  /// Takes one unless it has one. Where there is none, the next time.
  void hold() {
    if (descriptor_ < 0) descriptor_ = ::eventfd(0, EFD_CLOEXEC);
  }
  /// What is opened next has one, unless a thread that keeps none is faster. False: it had none.
  [[nodiscard]] bool give() { return descriptor_ >= 0 && ::close(std::exchange(descriptor_, -1)) == 0; }

  /// Given up as long as it lives.
  class Loan {
   public:
    explicit Loan(SpareDescriptor& spare) : spare_{spare} { (void)spare_.give(); }
    ~Loan() { spare_.hold(); }
    Loan(const Loan&) = delete;
    Loan& operator=(const Loan&) = delete;

   private:
    SpareDescriptor& spare_;
  };

 private:
  int descriptor_ = -1;
};

/// How many descriptors this process may have beside `others`; at least `least`.
[[nodiscard]] inline std::size_t descriptors_beside(std::size_t others, std::size_t least) {
  rlimit limit{};
  if (::getrlimit(RLIMIT_NOFILE, &limit) != 0) return least;
  const auto all = static_cast<std::size_t>(limit.rlim_cur);
  return std::max(least, all - std::min(all, others));
}

}  // namespace deltamap::daemon
