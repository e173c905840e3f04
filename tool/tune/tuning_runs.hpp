// SPDX-License-Identifier: Apache-2.0
// Settings that are compared, run on the same recordings with the same seeds.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "daemon/settings/settings.hpp"
#include "tool/tune/measured_run.hpp"
#include "tool/tune/run_book.hpp"
#include "tool/tune/tuned_drive.hpp"

namespace deltamap::tool::tune {

using Drives = std::vector<std::unique_ptr<TunedDrive>>;

/// One of the settings that are compared.
struct Variant {
  std::string name;                                           ///< as it is told: "localization.beams=60", "a.yaml"
  std::vector<std::pair<std::string, std::string>> values{};  ///< of the keys that differ, as YAML
  std::vector<daemon::Settings> settings{};                   ///< of each drive
};

/// One run that is wanted.
struct WantedRun {
  std::size_t variant = 0;
  std::size_t drive = 0;
  std::uint64_t seed = 0;
  friend bool operator==(const WantedRun&, const WantedRun&) = default;
};

/// Every variant on every drive with every seed, a drive and a seed at a time.
[[nodiscard]] std::vector<WantedRun> every_run(std::size_t variants, std::size_t drives,
                                               const std::vector<std::uint64_t>& seeds);

struct RunnerOptions {
  int jobs = 1;
  bool keeps_poses = false;                ///< MeasuredRun::poses
  bool keeps_decoded = false;              ///< the recordings, for runs that follow
  std::function<bool()> is_interrupted{};  ///< any thread; empty: never
};

/// Does what is not in the book yet and answers all, in the order wanted. `book` may be null. A bar on standard error
/// tells how far it is. Throws std::runtime_error; what had been done until then stands in the book.
[[nodiscard]] std::vector<MeasuredRun> results_of(const std::vector<WantedRun>& wanted,
                                                  const std::vector<Variant>& variants, Drives& drives, RunBook* book,
                                                  const RunnerOptions& options);

/// Names drive, settings and seed.
[[nodiscard]] std::string key_of(const WantedRun& run, const std::vector<Variant>& variants, const Drives& drives);

}  // namespace deltamap::tool::tune
