// SPDX-License-Identifier: Apache-2.0
// The experiments that there are.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "experiments/experiment.hpp"

namespace deltamap::experiments {

[[nodiscard]] std::unique_ptr<Experiment> hall_experiment();
[[nodiscard]] std::unique_ptr<Experiment> stale_map_experiment();
[[nodiscard]] std::unique_ptr<Experiment> verdict_experiment();
[[nodiscard]] std::unique_ptr<Experiment> fig2_4_experiment();
[[nodiscard]] std::unique_ptr<Experiment> fig6_experiment();
[[nodiscard]] std::unique_ptr<Experiment> fig13_experiment();
[[nodiscard]] std::unique_ptr<Experiment> fig14_experiment();
[[nodiscard]] std::unique_ptr<Experiment> table1_experiment();
[[nodiscard]] std::unique_ptr<Experiment> merge_experiment();
[[nodiscard]] std::unique_ptr<Experiment> gate_experiment();
[[nodiscard]] std::unique_ptr<Experiment> shifted_hall_experiment();
[[nodiscard]] std::unique_ptr<Experiment> unseen_experiment();
/// table2, fig10-12, endurance, and others of their kind.
[[nodiscard]] std::vector<std::unique_ptr<Experiment>> changing_world_experiments();

/// All, by name.
[[nodiscard]] std::vector<std::unique_ptr<Experiment>> experiments();

}  // namespace deltamap::experiments
