// SPDX-License-Identifier: Apache-2.0
// The command line that `score`, `compare` and `sweep` share: recordings, each with its map and what is known of the
// true way, and what they are run with.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <limits>
#include <string>
#include <utility>
#include <vector>

#include "tool/tune/tuning_runs.hpp"

namespace CLI {  // NOLINT(readability-identifier-naming): the name of the library
class App;
}

namespace deltamap::tool::tune {

struct TuningOptions {
  std::vector<std::string> recordings;
  std::vector<std::string> maps;
  std::vector<std::string> references;
  std::vector<std::string> relations;
  std::vector<std::string> truths;
  std::vector<std::string> poses;      ///< "X,Y,DEG", or "-"
  std::vector<std::string> overrides;  ///< "key=value", of all; "N:key=value", of the Nth recording
  bool of_laser = false;               ///< the references tell poses of the laser
  std::string config;
  int seeds = 4;
  int jobs = 0;  ///< 0: a processor each
  std::string by;
  double from_s = 0.0;
  double to_s = std::numeric_limits<double>::infinity();
  bool as_json = false;
};

/// All but recordings, config and seeds: these differ.
void add_tuning_options(CLI::App& command, TuningOptions& options);

/// Reads maps and true ways. What is given once is of all recordings, else there is one for each, in their order.
/// Throws std::runtime_error, SettingsError.
[[nodiscard]] Drives drives_of(const TuningOptions& options);

/// Of one of the recordings. Throw SettingsError.
[[nodiscard]] TrueWay true_way_of(const TuningOptions& options, std::size_t drive);
/// Empty where none is given.
[[nodiscard]] std::filesystem::path map_of(const TuningOptions& options, std::size_t drive);

/// The settings of each drive: configuration, overrides of all, those of the drive, then these. Throws SettingsError.
[[nodiscard]] Variant variant_of(const std::string& name, const std::string& config,
                                 const std::vector<std::pair<std::string, std::string>>& values, const Drives& drives);

/// 1, 2, …
[[nodiscard]] std::vector<std::uint64_t> seeds_from(std::uint64_t first, int count);
[[nodiscard]] int jobs_of(const TuningOptions& options);
/// The measure that is asked for; else what the true ways allow: error_rmse_m, relation_m, or agreement. Throws
/// SettingsError where no recording's true way gives the one that is asked for; `needs_all`: where one does not.
[[nodiscard]] const Measure& deciding_measure(const TuningOptions& options, const Drives& drives, bool needs_all);

/// Once a command, before its first run: a signal from before is forgotten. Since then, has a person ended the program
/// (Ctrl-C)?
[[nodiscard]] std::function<bool()> watch_for_interrupt();

/// What a person should know of the drives before all else, on standard error: what recordings lack, the mount.
void warn_of(Drives& drives, const Variant& variant);
/// And behind it: recordings whose beams agree with their map in no run.
void warn_of_foreign_maps(const std::vector<WantedRun>& wanted, const std::vector<MeasuredRun>& runs,
                          const Drives& drives);

}  // namespace deltamap::tool::tune
