// SPDX-License-Identifier: Apache-2.0
// One drive through a world that nobody has tuned on: what `unseen` measures, and `ablation` with one thing changed.
#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include "experiments/experiment.hpp"

namespace deltamap::experiments {

/// Seeds 1 to 999 are for development, 1000 to 1059 for final figures alone; throws SettingsError where `first` to
/// `last` mixes them.
void expect_one_set(std::uint64_t first, std::uint64_t last);

/// How many seeds, and how long each drive is, where nobody says otherwise.
struct UnseenRuns {
  int seeds;
  int quick_seeds;
  double minutes;
  double quick_minutes;
};
/// A run for each seed; throws as expect_one_set().
[[nodiscard]] std::vector<Run> unseen_runs(const Options& options, const UnseenRuns& usual,
                                           const std::function<Outcome(std::uint64_t seed, double minutes)>& drive);

/// Another kind of building, map, laser, robot and life in it for every seed; labels and numbers begin with the kind.
[[nodiscard]] Outcome unseen_drive(std::uint64_t seed, double minutes, const localization::LocalizerParams& localizer,
                                   const daemon::MappingSettings& mapping);

}  // namespace deltamap::experiments
