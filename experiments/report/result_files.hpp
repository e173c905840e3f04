// SPDX-License-Identifier: Apache-2.0
// An experiment's results as files: a table of the runs (CSV), the figures (JSON), and one page to look at (HTML). Each
// is there whole or not at all.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "daemon/settings/settings.hpp"
#include "experiments/experiment.hpp"

namespace deltamap::experiments {

struct Results {
  std::string name;
  std::string what;
  std::uint64_t seed = 1;
  bool quick = false;
  std::vector<Run> runs;
  std::vector<Outcome> outcomes;  ///< of each run
  Report report;
  daemon::Settings settings{};  ///< of the localizer and of mapping; an experiment may set some of them itself
};

/// "met", "missed" or "nothing measured"; empty: nothing was promised of it.
[[nodiscard]] std::string_view verdict_on(const Figure& figure);

/// Throws std::runtime_error where nothing can be written there.
void expect_writable(const std::filesystem::path& folder);

[[nodiscard]] std::string runs_csv(const Results& results);
[[nodiscard]] std::string scans_csv(const ScanTable& scans);
[[nodiscard]] std::string summary_json(const Results& results);
/// "≥ 0.9, ≤ 0.98"
[[nodiscard]] std::string text_of(const Target& target);
[[nodiscard]] std::string page_html(const Results& results);

/// NAME.csv, summary.json, index.html and, where wanted, scans/RUN.csv. Throws std::runtime_error naming the file.
void write_results(const Results& results, const std::filesystem::path& folder, bool with_scans);

}  // namespace deltamap::experiments
