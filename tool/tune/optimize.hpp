// SPDX-License-Identifier: Apache-2.0
// `deltamap sweep --optimize N`: several keys searched within a budget of runs, and the winner held against the
// settings as given on recordings or seeds that the search did not see.
#pragma once

#include <vector>

#include "tool/tune/halving.hpp"
#include "tool/tune/parameter.hpp"
#include "tool/tune/sweep_folder.hpp"
#include "tool/tune/tuning_result.hpp"

namespace deltamap::tool::tune {

/// Searches, confirms, writes the result into the folder and prints it. Throws std::runtime_error, SettingsError.
void optimize(const SweepOptions& options, const std::vector<Parameter>& parameters, Drives& drives,
              const Variant& base, const Measure& measure);

/// How a budget is shared out: a quarter of the runs confirms, in pairs, at least two seeds a recording.
struct BudgetShares {
  std::size_t search = 0;
  std::size_t seeds_to_confirm = 0;
};
/// Throws SettingsError where too little is left to search with.
[[nodiscard]] BudgetShares shares_of(std::size_t budget, std::size_t drives_to_confirm);

}  // namespace deltamap::tool::tune
