// SPDX-License-Identifier: Apache-2.0
// `deltamap sweep`: which value of a key is best on these recordings, and which are as good.
#include <CLI/CLI.hpp>
#include <algorithm>
#include <filesystem>
#include <iostream>
#include <memory>

#include "core/files/replace_file.hpp"
#include "tool/subcommands.hpp"
#include "tool/tune/optimize.hpp"
#include "tool/tune/parameter.hpp"
#include "tool/tune/sweep_folder.hpp"
#include "tool/tune/sweep_page.hpp"
#include "tool/tune/tuning_options.hpp"
#include "tool/tune/tuning_result.hpp"

namespace deltamap::tool {
namespace {

using tune::Drives;
using tune::Parameter;
using tune::Variant;

constexpr std::size_t kMostSettings = 10000;

using tune::SweepOptions;

std::vector<Parameter> parameters_of(const std::vector<std::string>& texts) {
  std::vector<Parameter> parameters;
  for (const std::string& text : texts) {
    parameters.push_back(tune::parameter_of(text));
    const auto same = [&](const Parameter& one) { return one.key == parameters.back().key; };
    if (std::count_if(parameters.begin(), parameters.end(), same) > 1)
      throw daemon::SettingsError("--param " + text + ": '" + parameters.back().key + "' is given twice");
  }
  return parameters;
}

/// Every value of the first key with every value of the others, the last one changing first.
std::vector<Variant> grid_of(const std::vector<Parameter>& parameters, const SweepOptions& options,
                             const Drives& drives) {
  std::size_t count = 1;
  for (const Parameter& parameter : parameters) {
    if (parameter.values.size() > kMostSettings / count) {
      throw daemon::SettingsError("--param: that are more than " + std::to_string(kMostSettings) +
                                  " settings; give fewer values, or search them with --optimize");
    }
    count *= parameter.values.size();
  }
  std::vector<Variant> variants;
  for (std::size_t i = 0; i < count; ++i) {
    std::vector<std::pair<std::string, std::string>> values(parameters.size());
    std::string name;
    std::size_t rest = i;
    for (std::size_t p = parameters.size(); p-- > 0;) {
      const std::vector<std::string>& own = parameters[p].values;
      values[p] = {parameters[p].key, own[rest % own.size()]};
      rest /= own.size();
    }
    for (const auto& [key, value] : values) name.append(name.empty() ? "" : ", ").append(key).append("=").append(value);
    variants.push_back(tune::variant_of(name, options.common.config, values, drives));
  }
  return variants;
}

void tell(const tune::TuningResult& result, const tune::Ranking& ranking, bool as_json) {
  if (as_json) {
    std::cout << tune::sweep_json(result, ranking);
    return;
  }
  std::cout << tune::padded(tune::sweep_table(result, ranking));
  for (const std::string& line : tune::sweep_words(result, ranking)) std::cout << line << '\n';
}

void run_sweep(const SweepOptions& options) {
  const std::vector<Parameter> parameters = parameters_of(options.params);
  Drives drives = tune::drives_of(options.common);
  const tune::Measure& measure = tune::deciding_measure(options.common, drives, options.budget > 0);
  const Variant base = tune::variant_of("as given", options.common.config, {}, drives);
  if (options.budget > 0) return tune::optimize(options, parameters, drives, base, measure);
  std::vector<Variant> variants = grid_of(parameters, options, drives);
  tune::warn_of(drives, base);
  tune::RunBook book{options.out, tune::header_of(drives, base), options.anew};
  const auto seeds = tune::seeds_from(1, options.common.seeds);
  const auto wanted = tune::every_run(variants.size(), drives.size(), seeds);
  auto runs = tune::kept_results(wanted, variants, drives, book, options, tune::watch_for_interrupt());
  tune::warn_of_foreign_maps(wanted, runs, drives);
  const tune::TuningResult result{drives, std::move(variants), seeds, wanted, std::move(runs), measure};
  const tune::Ranking ranking = result.ranking();
  replace_file(options.out / "sweep.json", tune::sweep_json(result, ranking));
  replace_file(options.out / "index.html", tune::sweep_page(result, ranking));
  tell(result, ranking, options.common.as_json);
}

}  // namespace

void add_sweep(CLI::App& app) {
  auto options = std::make_shared<SweepOptions>();
  CLI::App& command = *app.add_subcommand("sweep", "recordings replayed with every value of some keys: which is best");
  command.add_option("RECORDING", options->common.recordings, "pcapng of both ports, one or several")->required();
  command.add_option("--config", options->common.config, "settings, YAML; as delivered where it is not given");
  command.add_option("--param", options->params, "key=a:b:n, key=a:b:n:log or key=v,v; repeatable: every combination")
      ->required()
      ->allow_extra_args(false);
  command.add_option("--seeds", options->common.seeds, "each value with seeds 1 to N (default 4)")
      ->check(CLI::Range(1, 10000));
  command.add_option("--by", options->common.by,
                     "the measure that decides (default: by what is known of the true way)");
  command.add_option("--out", options->out,
                     "folder for the runs and the result (default sweep); goes on with what is there");
  command.add_flag("--anew", options->anew, "leave what is there");
  command
      .add_option("--optimize", options->budget,
                  "search the ranges of all keys with so many runs, in place of every value")
      ->check(CLI::Range(1, 1000000));
  command
      .add_option("--hold-out", options->held_out,
                  "so many recordings, the last ones, that --optimize keeps for the confirmation")
      ->check(CLI::NonNegativeNumber);
  command.add_option("--search-seed", options->search_seed, "of what --optimize draws (default 1)");
  tune::add_tuning_options(command, options->common);
  command.callback([options] { run_sweep(*options); });
}

}  // namespace deltamap::tool
