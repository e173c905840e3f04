// SPDX-License-Identifier: Apache-2.0
// `deltamap sweep`: which value of a key is best on these recordings, and which are as good.
#include <CLI/CLI.hpp>
#include <algorithm>
#include <filesystem>
#include <iostream>
#include <memory>
#include <nlohmann/json.hpp>
#include <stdexcept>

#include "core/files/replace_file.hpp"
#include "daemon/telemetry/version.hpp"
#include "tool/subcommands.hpp"
#include "tool/tune/parameter.hpp"
#include "tool/tune/tuning_options.hpp"
#include "tool/tune/tuning_result.hpp"

namespace deltamap::tool {
namespace {

using tune::Drives;
using tune::Parameter;
using tune::Variant;

constexpr std::size_t kMostSettings = 10000;

struct SweepOptions {
  tune::TuningOptions common;
  std::vector<std::string> params;
  std::filesystem::path out = "sweep";
  bool anew = false;
};

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
  for (const Parameter& parameter : parameters) count *= parameter.values.size();
  if (count > kMostSettings) {
    throw daemon::SettingsError("--param: that are " + std::to_string(count) + " settings; at most " +
                                std::to_string(kMostSettings) + ", or search them with --optimize");
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
    for (const auto& [key, value] : values) name += (name.empty() ? "" : ", ") + key + "=" + value;
    variants.push_back(tune::variant_of(name, options.common.config, values, drives));
  }
  return variants;
}

/// What all runs of the folder have in common.
std::string header_of(const Drives& drives, const Variant& base) {
  nlohmann::ordered_json header{
      {"made_by", std::string{daemon::version()} + ", commit " + std::string{daemon::commit()}}};
  for (std::size_t i = 0; i < drives.size(); ++i) {
    const tune::DriveFiles& files = drives[i]->files();
    nlohmann::ordered_json drive{
        {"content", drives[i]->identity()}, {"of_laser", files.way.of_laser}, {"from_s", files.from_s}};
    if (files.to_s < 1e300) drive["to_s"] = files.to_s;
    drive["settings"] = nlohmann::ordered_json::object();
    for (const auto& [key, value] : daemon::changed_settings(base.settings[i])) drive["settings"][key] = value;
    header["drives"][files.name] = drive;
  }
  return header.dump();
}

/// A person who ends it, or a full disk, keeps what is done.
std::vector<tune::MeasuredRun> runs_or_how_to_go_on(const std::vector<tune::WantedRun>& wanted,
                                                    const std::vector<Variant>& variants, Drives& drives,
                                                    tune::RunBook& book, const SweepOptions& options) {
  const auto is_interrupted = tune::watch_for_interrupt();
  try {
    return tune::results_of(wanted, variants, drives, &book, {tune::jobs_of(options.common), false, is_interrupted});
  } catch (const std::runtime_error&) {
    if (!is_interrupted()) throw;
    const auto done = static_cast<std::size_t>(std::count_if(wanted.begin(), wanted.end(), [&](const auto& one) {
      return book.run(tune::key_of(one, variants, drives)).has_value();
    }));
    throw std::runtime_error("interrupted: " + std::to_string(done) + " of " + std::to_string(wanted.size()) +
                             " runs are kept in " + options.out.string() + "; the same command goes on from there");
  }
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
  const tune::Measure& measure = tune::deciding_measure(options.common, drives);
  const Variant base = tune::variant_of("as given", options.common.config, {}, drives);
  std::vector<Variant> variants = grid_of(parameters, options, drives);
  tune::warn_of(drives, base);
  tune::RunBook book{options.out, header_of(drives, base), options.anew};
  const auto seeds = tune::seeds_from(1, options.common.seeds);
  const auto wanted = tune::every_run(variants.size(), drives.size(), seeds);
  auto runs = runs_or_how_to_go_on(wanted, variants, drives, book, options);
  tune::warn_of_foreign_maps(wanted, runs, drives);
  const tune::TuningResult result{drives, std::move(variants), seeds, wanted, std::move(runs), measure};
  const tune::Ranking ranking = result.ranking();
  replace_file(options.out / "sweep.json", tune::sweep_json(result, ranking));
  tell(result, ranking, options.common.as_json);
}

}  // namespace

void add_sweep(CLI::App& app) {
  auto options = std::make_shared<SweepOptions>();
  CLI::App& command = *app.add_subcommand("sweep", "recordings replayed with every value of some keys: which is best");
  command.add_option("recordings", options->common.recordings, "pcapng of both ports, one or several")->required();
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
  tune::add_tuning_options(command, options->common);
  command.callback([options] { run_sweep(*options); });
}

}  // namespace deltamap::tool
