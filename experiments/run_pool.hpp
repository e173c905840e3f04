// SPDX-License-Identifier: Apache-2.0
// Does the runs of an experiment, several at once. What they bring comes back in their order, whoever was first.
#pragma once

#include <functional>
#include <vector>

#include "experiments/experiment.hpp"

namespace deltamap::experiments {

/// `done` is told after each run how many are; one call at a time. The first exception of a run is thrown on, once all
/// that had begun have ended. jobs > 0.
[[nodiscard]] std::vector<Outcome> outcomes_of(const std::vector<Run>& runs, int jobs,
                                               const std::function<void(std::size_t)>& done);

}  // namespace deltamap::experiments
