// SPDX-License-Identifier: Apache-2.0
#include "core/work_pool.hpp"

#include <algorithm>
#include <atomic>
#include <exception>
#include <mutex>
#include <thread>
#include <vector>

namespace deltamap {

void work_through(std::size_t pieces, int jobs, const std::function<void(std::size_t)>& work,
                  const std::function<void(std::size_t)>& done) {
  std::atomic<std::size_t> next{0};
  std::mutex telling;
  std::exception_ptr failure;
  const auto work_on = [&] {
    for (std::size_t i = next++; i < pieces; i = next++) {
      try {
        work(i);
        const std::lock_guard lock{telling};
        done(i);
      } catch (...) {
        const std::lock_guard lock{telling};
        if (!failure) failure = std::current_exception();
        next = pieces;
      }
    }
  };
  {
    std::vector<std::jthread> workers;
    const std::size_t count = std::min(static_cast<std::size_t>(jobs), pieces);
    for (std::size_t i = 0; i < count; ++i) workers.emplace_back(work_on);
  }
  if (failure) std::rethrow_exception(failure);
}

}  // namespace deltamap
