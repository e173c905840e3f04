// SPDX-License-Identifier: Apache-2.0
#include "experiments/run_pool.hpp"

#include <algorithm>
#include <atomic>
#include <exception>
#include <mutex>
#include <thread>

namespace deltamap::experiments {

std::vector<Outcome> outcomes_of(const std::vector<Run>& runs, int jobs, const std::function<void(std::size_t)>& done) {
  std::vector<Outcome> outcomes(runs.size());
  std::atomic<std::size_t> next{0};
  std::mutex telling;
  std::size_t finished = 0;
  std::exception_ptr failure;
  const auto work = [&] {
    for (std::size_t i = next++; i < runs.size(); i = next++) {
      try {
        outcomes[i] = runs[i].work();
        const std::lock_guard lock{telling};
        done(++finished);
      } catch (...) {
        const std::lock_guard lock{telling};
        if (!failure) failure = std::current_exception();
        next = runs.size();
      }
    }
  };
  {
    std::vector<std::jthread> workers;
    const std::size_t count = std::min(static_cast<std::size_t>(jobs), runs.size());
    for (std::size_t i = 0; i < count; ++i) workers.emplace_back(work);
  }
  if (failure) std::rethrow_exception(failure);
  return outcomes;
}

}  // namespace deltamap::experiments
