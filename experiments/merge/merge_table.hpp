// SPDX-License-Identifier: Apache-2.0
// What came of many merges: a row for each, and the numbers that are made of them.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "experiments/experiment.hpp"
#include "experiments/merge/merge_places.hpp"
#include "experiments/pooled_runs.hpp"

namespace deltamap::experiments {

[[nodiscard]] ScanTable empty_merge_table();
void add_merge(ScanTable& merges, double true_turn_deg, const MergeMeasure& measure, bool is_refused, double taken_ms);

/// A merge is *right* within 1 cell (at the local map's middle) and 1° of the truth, *wrong* beyond 3 cells or 1.5°.
/// Acceptance, right and time are of all transforms; errors and shortfalls of those that were not refused.
[[nodiscard]] std::vector<std::pair<std::string, double>> merge_numbers(const ScanTable& merges);

/// By how much the acceptance of each merge that was not refused falls short of the true pose's own.
[[nodiscard]] std::vector<double> shortfalls(const ScanTable& merges);

/// The numbers of the merges of all outcomes with these labels, and how sure they are.
[[nodiscard]] PooledRuns pooled_merges(const std::vector<Outcome>& outcomes,
                                       const std::vector<std::pair<std::string, std::string>>& labels);

/// The numbers of these merges, as one outcome.
[[nodiscard]] Outcome together(const ScanTable& merges);

/// The merges of all outcomes whose labels are these.
[[nodiscard]] ScanTable merges_of(const std::vector<Outcome>& outcomes,
                                  const std::vector<std::pair<std::string, std::string>>& labels);

}  // namespace deltamap::experiments
