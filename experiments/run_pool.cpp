// SPDX-License-Identifier: Apache-2.0
#include "experiments/run_pool.hpp"

#include "core/work_pool.hpp"

namespace deltamap::experiments {

std::vector<Outcome> outcomes_of(const std::vector<Run>& runs, int jobs, const std::function<void(std::size_t)>& done) {
  std::vector<Outcome> outcomes(runs.size());
  std::size_t finished = 0;
  work_through(
      runs.size(), jobs, [&](std::size_t i) { outcomes[i] = runs[i].work(); }, [&](std::size_t) { done(++finished); });
  return outcomes;
}

}  // namespace deltamap::experiments
