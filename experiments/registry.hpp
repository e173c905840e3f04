// SPDX-License-Identifier: Apache-2.0
// The experiments that there are.
#pragma once

#include <vector>

#include "experiments/experiment.hpp"

namespace deltamap::experiments {

[[nodiscard]] Experiment faults_experiment();
[[nodiscard]] Experiment good_driving_experiment();
[[nodiscard]] Experiment hall_experiment();
[[nodiscard]] Experiment stale_map_experiment();
[[nodiscard]] Experiment verdict_experiment();
[[nodiscard]] Experiment fig2_4_experiment();
[[nodiscard]] Experiment fig6_experiment();
[[nodiscard]] Experiment fig13_experiment();
[[nodiscard]] Experiment fig14_experiment();
[[nodiscard]] Experiment table1_experiment();
[[nodiscard]] Experiment merge_experiment();
[[nodiscard]] Experiment gate_experiment();
[[nodiscard]] Experiment carried_experiment();
[[nodiscard]] Experiment incidents_experiment();
[[nodiscard]] Experiment shifted_hall_experiment();
[[nodiscard]] Experiment things_experiment();
[[nodiscard]] Experiment bays_experiment();
[[nodiscard]] Experiment zones_experiment();
[[nodiscard]] Experiment unseen_experiment();
[[nodiscard]] Experiment first_map_experiment();
[[nodiscard]] Experiment bent_maps_experiment();
[[nodiscard]] Experiment ablation_experiment();
/// table2, fig10-12, endurance, and others of their kind.
[[nodiscard]] std::vector<Experiment> changing_world_experiments();

/// All, by name.
[[nodiscard]] std::vector<Experiment> experiments();

}  // namespace deltamap::experiments
