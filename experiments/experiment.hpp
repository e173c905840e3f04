// SPDX-License-Identifier: Apache-2.0
// What an experiment is: runs that know nothing of each other, each with what it measured, and a report that is made of
// them all. The same options give the same results, however many runs go on at once.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "core/statistics/certainty.hpp"
#include "daemon/settings/settings.hpp"
#include "experiments/scan_table.hpp"
#include "localization/localizer_params.hpp"
#include "reports/chart.hpp"

namespace deltamap::experiments {

struct Options {
  std::filesystem::path scenarios = "config/scenarios";
  std::optional<std::filesystem::path> data{};  ///< recorded maps
  std::uint64_t seed = 1;
  bool quick = false;                         ///< fewer runs, shorter drives: to see that it works
  std::optional<double> minutes{};            ///< of one drive, in place of the experiment's, > 0
  std::optional<int> repeats{};               ///< seeds or runs a cell, in place of the experiment's, > 0
  localization::LocalizerParams localizer{};  ///< as the daemon would have it
  daemon::MappingSettings mapping{};          ///< the same

  /// Of one cell: as many as are asked for; else `whole`, one where it is to be quick.
  [[nodiscard]] std::vector<std::uint64_t> seeds(int whole) const;
};

struct Picture {
  std::string title;
  std::string svg;
};

/// What one run has to show: a line of NAME.csv, and its scans.
struct Outcome {
  std::vector<std::pair<std::string, std::string>> labels;  ///< what was done
  std::vector<std::pair<std::string, double>> numbers;      ///< what came out
  ScanTable scans;
  std::vector<Picture> pictures{};  ///< for the report to choose from

  [[nodiscard]] const std::string& label(std::string_view name) const;
  [[nodiscard]] double number(std::string_view name) const;
};

struct Run {
  std::string name;  ///< unique in the experiment, fit for a file's name
  std::function<Outcome()> work;
  bool is_baseline = false;  ///< what others are compared with: done whatever --only says
};

/// What was promised of a figure.
struct Target {
  std::optional<double> least{};
  std::optional<double> most{};

  [[nodiscard]] bool is_met_by(double value) const { return (!least || value >= *least) && (!most || value <= *most); }
};

struct Figure {
  std::string name;
  double value = 0.0;  ///< NaN where there is nothing to measure
  std::string unit{};  ///< empty: a share or a count
  std::optional<Target> target{};
  std::string peers{};                   ///< what others reach
  std::optional<Certainty> certainty{};  ///< of a figure that is made of runs
};

using reports::Chart;
using reports::Series;

struct TextTable {
  std::string title;
  std::vector<std::string> columns;
  std::vector<std::vector<std::string>> rows;
};

struct Report {
  std::vector<Figure> figures;
  std::vector<Chart> charts;
  std::vector<TextTable> tables;
  std::vector<Picture> pictures{};
};

struct Experiment {
  std::string name;
  std::string what;  ///< one line
  /// Throws std::runtime_error where a scenario cannot be read.
  std::function<std::vector<Run>(const Options&)> runs;
  /// Of the outcomes in the order of the runs.
  std::function<Report(const std::vector<Outcome>&)> report;
  /// Then numbers that end in _ms or _mb differ from one time to the next.
  enum class Times : std::uint8_t {
    kNothing,
    kThread,  ///< the CPU time of the run's thread
    kMachine  ///< one run at a time: others beside it would be measured too
  } times = Times::kNothing;
};

}  // namespace deltamap::experiments
