// SPDX-License-Identifier: Apache-2.0
// What the runs of `verdict` come to: figures against their targets, a table of each place, and how reliable the two
// probabilities are.
#pragma once

#include <array>
#include <vector>

#include "experiments/experiment.hpp"

namespace deltamap::experiments {

// What the runs differ in, besides place, event and seed.
inline constexpr std::array kVerdictChangedShares{0.0, 0.1, 0.5};
inline constexpr std::array kVerdictRanges_m{80.0, 8.0};  ///< runs take turns

[[nodiscard]] Report verdict_report(const std::vector<Outcome>& outcomes);

}  // namespace deltamap::experiments
