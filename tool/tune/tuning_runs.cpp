// SPDX-License-Identifier: Apache-2.0
#include "tool/tune/tuning_runs.hpp"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <filesystem>
#include <mutex>
#include <optional>
#include <stdexcept>
#include <system_error>

#include "core/work_pool.hpp"
#include "daemon/settings/fingerprint.hpp"
#include "tool/progress.hpp"

namespace deltamap::tool::tune {
namespace {

daemon::Settings settings_of(const WantedRun& run, const std::vector<Variant>& variants) {
  daemon::Settings settings = variants[run.variant].settings[run.drive];
  settings.seed = run.seed;
  return settings;
}

/// How far all runs together are, told by whichever thread comes first.
class SharedProgress {
 public:
  explicit SharedProgress(std::size_t runs) : bar_{"runs", runs * kSteps} {}

  /// One run has come so much farther, in steps.
  void add(std::uint64_t steps) {
    const std::uint64_t done = done_ += steps;
    const std::unique_lock lock{drawing_, std::try_to_lock};
    if (lock) bar_.show(done);
  }

  static constexpr std::uint64_t kSteps = 1000;  // of a run

 private:
  Progress bar_;
  std::atomic<std::uint64_t> done_{0};
  std::mutex drawing_;
};

/// Runs of one drive follow each other, so that no more drives are in memory than are at work; long drives first, so
/// that no thread is left alone with one at the end.
std::vector<std::size_t> order_of(const std::vector<std::size_t>& missing, const std::vector<WantedRun>& wanted,
                                  const Drives& drives) {
  std::vector<std::uintmax_t> sizes;
  for (const auto& drive : drives) {
    std::error_code error;
    const std::uintmax_t size = std::filesystem::file_size(drive->files().recording, error);
    sizes.push_back(error ? 0 : size);  // whoever reads it tells why
  }
  std::vector<std::size_t> order = missing;
  std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
    const auto rank = [&](std::size_t i) { return std::pair{sizes[wanted[i].drive], wanted[i].drive}; };
    return rank(a) > rank(b);
  });
  return order;
}

}  // namespace

std::vector<WantedRun> every_run(std::size_t variants, std::size_t drives, const std::vector<std::uint64_t>& seeds) {
  std::vector<WantedRun> runs;
  for (std::size_t drive = 0; drive < drives; ++drive) {
    for (const std::uint64_t seed : seeds) {
      for (std::size_t variant = 0; variant < variants; ++variant) runs.push_back({variant, drive, seed});
    }
  }
  return runs;
}

std::string key_of(const WantedRun& run, const std::vector<Variant>& variants, const Drives& drives) {
  return drives[run.drive]->files().name + " " + daemon::hex_of(settings_fingerprint(settings_of(run, variants)));
}

std::vector<MeasuredRun> results_of(const std::vector<WantedRun>& wanted, const std::vector<Variant>& variants,
                                    Drives& drives, RunBook* book, const RunnerOptions& options) {
  std::vector<MeasuredRun> results(wanted.size());
  std::vector<std::size_t> missing;
  std::vector<std::size_t> left(drives.size());
  for (std::size_t i = 0; i < wanted.size(); ++i) {
    auto done = book == nullptr ? std::nullopt : book->run(key_of(wanted[i], variants, drives));
    if (done) {
      results[i] = *std::move(done);
      continue;
    }
    missing.push_back(i);
    ++left[wanted[i].drive];
  }
  const std::vector<std::size_t> order = order_of(missing, wanted, drives);
  SharedProgress progress{order.size()};
  const auto work = [&](std::size_t i) {
    const WantedRun& run = wanted[order[i]];
    std::uint64_t told = 0;
    results[order[i]] = measured_run(*drives[run.drive], settings_of(run, variants), [&](double share) {
      const auto steps = static_cast<std::uint64_t>(share * SharedProgress::kSteps);
      if (steps > told) progress.add(steps - told);
      told = std::max(told, steps);
      return !options.is_interrupted || !options.is_interrupted();
    });
  };
  const auto done = [&](std::size_t i) {
    MeasuredRun& result = results[order[i]];
    if (book != nullptr) book->add(key_of(wanted[order[i]], variants, drives), result);
    if (!options.keeps_poses) result.poses = {};
    if (--left[wanted[order[i]].drive] == 0 && !options.keeps_decoded) drives[wanted[order[i]].drive]->forget_decoded();
  };
  work_through(order.size(), options.jobs, work, done);
  return results;
}

}  // namespace deltamap::tool::tune
