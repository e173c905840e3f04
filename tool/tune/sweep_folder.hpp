// SPDX-License-Identifier: Apache-2.0
// What a sweep is asked for, and the folder that keeps its runs.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "tool/tune/tuning_options.hpp"

namespace deltamap::tool::tune {

struct SweepOptions {
  TuningOptions common;
  std::vector<std::string> params;
  std::filesystem::path out = "sweep";
  bool anew = false;
  std::size_t budget = 0;    ///< of --optimize; 0: every value
  std::size_t held_out = 0;  ///< recordings that only the confirmation sees
  std::uint64_t search_seed = 1;
};

/// What all runs of the folder have in common, as RunBook takes it: the program, what the files hold, the settings that
/// are not tried.
[[nodiscard]] std::string header_of(const Drives& drives, const Variant& base);

/// As results_of(); where a person ends it, the error tells how to go on. `is_interrupted`: of watch_for_interrupt().
[[nodiscard]] std::vector<MeasuredRun> kept_results(const std::vector<WantedRun>& wanted,
                                                    const std::vector<Variant>& variants, Drives& drives, RunBook& book,
                                                    const SweepOptions& options,
                                                    const std::function<bool()>& is_interrupted);

}  // namespace deltamap::tool::tune
