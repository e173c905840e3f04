// SPDX-License-Identifier: Apache-2.0
// `deltamap compare`: is one of these configurations better on these recordings?
#include <CLI/CLI.hpp>
#include <filesystem>
#include <iostream>
#include <memory>

#include "daemon/settings/settings_error.hpp"
#include "tool/subcommands.hpp"
#include "tool/tune/tuning_options.hpp"
#include "tool/tune/tuning_result.hpp"

namespace deltamap::tool {
namespace {

struct CompareOptions {
  tune::TuningOptions common;
  std::vector<std::string> configs;
};

/// The file's name; the whole path where two have the same.
std::string name_among(const std::string& config, const std::vector<std::string>& configs) {
  const auto own = std::filesystem::path(config).filename();
  std::size_t same = 0;
  for (const std::string& other : configs) same += std::filesystem::path(other).filename() == own ? 1 : 0;
  return same > 1 ? config : own.string();
}

void run_compare(const CompareOptions& options) {
  if (options.configs.size() < 2) throw daemon::SettingsError("--config: give two or more, what is compared");
  tune::Drives drives = tune::drives_of(options.common);
  const tune::Measure& measure = tune::deciding_measure(options.common, drives, false);
  std::vector<tune::Variant> variants;
  for (const std::string& config : options.configs)
    variants.push_back(tune::variant_of(name_among(config, options.configs), config, {}, drives));
  tune::warn_of(drives, variants.front());
  const auto seeds = tune::seeds_from(1, options.common.seeds);
  const auto wanted = tune::every_run(variants.size(), drives.size(), seeds);
  auto runs = tune::results_of(wanted, variants, drives, nullptr,
                               {tune::jobs_of(options.common), false, false, tune::watch_for_interrupt()});
  tune::warn_of_foreign_maps(wanted, runs, drives);
  const tune::TuningResult result{drives, std::move(variants), seeds, wanted, std::move(runs), measure};
  if (options.common.as_json) {
    std::cout << tune::compare_json(result);
    return;
  }
  for (std::size_t second = 1; second < result.variants.size(); ++second) {
    std::cout << (second > 1 ? "\n" : "") << tune::padded(tune::compare_table(result, 0, second))
              << tune::compare_words(result, 0, second) << '\n';
  }
}

}  // namespace

void add_compare(CLI::App& app) {
  auto options = std::make_shared<CompareOptions>();
  CLI::App& command = *app.add_subcommand("compare", "recordings replayed with several configurations: is one better");
  command.add_option("RECORDING", options->common.recordings, "pcapng of both ports, one or several")->required();
  command
      .add_option("--config", options->configs,
                  "settings, YAML; two or more: the first is what the others are held against")
      ->required()
      ->allow_extra_args(false);
  command.add_option("--seeds", options->common.seeds, "each configuration with seeds 1 to N (default 4)")
      ->check(CLI::Range(1, 10000));
  command.add_option("--by", options->common.by,
                     "the measure that decides (default: by what is known of the true way)");
  tune::add_tuning_options(command, options->common);
  command.callback([options] { run_compare(*options); });
}

}  // namespace deltamap::tool
