// SPDX-License-Identifier: Apache-2.0
// The daemon's whole pipeline - its threads, both ports, store, recording, files and what it keeps for the next run -
// over hours of virtual time in a world that changes, and what it holds in memory meanwhile.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "daemon/outputs/outputs.hpp"
#include "experiments/watch/mapping_run.hpp"

namespace deltamap::experiments {

/// What the process holds, the simulator included.
struct MemorySample {
  double passed_s = 0.0;  ///< of the drive
  double heap_mb = 0.0;  ///< in use, the least since the sample before: what swings with scans on their way is left out
  double resident_mb = 0.0;  ///< now
};

struct PipelineDay {
  std::vector<MemorySample> samples;  ///< evenly over the drive: every hour, at least eight
  daemon::RunReport report;
  std::vector<std::string> warnings;  ///< of what was degraded

  /// From the end of the settling time to the end of the drive, in the least heap of an hour; NaN where the drive is
  /// over before.
  [[nodiscard]] double heap_growth_mb() const;
  /// The same in the resident memory at the end of these hours.
  [[nodiscard]] double resident_growth_mb() const;
};

/// Hours after which nearly all of what is bounded by the size of the world is there: the tiles of votes.
inline constexpr double kSettling_h = 4.0;
/// To be called flat: what may still be missing from these bounds in a hall of 35 m × 35 m. By then it has 0.9 of its
/// tiles (0.46 MB are left) and 3400 of the 8192 places that are written back and forth (0.19 MB).
inline constexpr double kMostHeapGrowth_mb = 0.75;

/// Nothing else may be at work in the process. Throws std::runtime_error where a stage fails. `sampled`: told of each
/// sample at once, in the io thread; may be empty.
[[nodiscard]] PipelineDay pipeline_day(const MappingRun& run, std::function<void(const MemorySample&)> sampled = {});

/// Its numbers and its samples; no labels.
[[nodiscard]] Outcome outcome_of(const PipelineDay& day);

}  // namespace deltamap::experiments
