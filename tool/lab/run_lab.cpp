// SPDX-License-Identifier: Apache-2.0
#include "tool/lab/run_lab.hpp"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <csignal>
#include <iomanip>
#include <iostream>
#include <memory>
#include <thread>

#include "daemon/settings/settings.hpp"
#include "daemon/telemetry/version.hpp"
#include "experiments/registry.hpp"
#include "experiments/report/result_files.hpp"
#include "experiments/run_pool.hpp"
#include "tool/command_line.hpp"
#include "tool/progress.hpp"
#include "tool/scenario_place.hpp"

namespace deltamap::tool {
namespace {

struct ExperimentOptions {
  std::string name;
  std::filesystem::path out;
  std::string config;
  std::vector<std::string> overrides;
  int jobs = std::max(1, static_cast<int>(std::thread::hardware_concurrency()));
  std::string only;  // part of a run's name
  bool with_scans = false;
  bool as_json = false;
  experiments::Options options;
};

std::string names_of_experiments() {
  std::string names;
  for (const auto& known : experiments::experiments()) names += (names.empty() ? "" : ", ") + known.name;
  return names;
}

experiments::Experiment experiment_named(const std::string& name) {
  for (auto& known : experiments::experiments()) {
    if (known.name == name) return std::move(known);
  }
  throw CLI::ValidationError{"there is no experiment '" + name + "'; there are " + names_of_experiments()};
}

bool runs_alone(const experiments::Experiment& experiment) {
  return experiment.times == experiments::Experiment::Times::kMachine;
}

/// A line each: its name, whether it measures the machine, and what it is.
void list_experiments() {
  for (const auto& known : experiments::experiments()) {
    std::cout << known.name << '\t' << (runs_alone(known) ? "times" : "") << '\t' << known.what << '\n';
  }
}

void print_summary(const experiments::Results& results) {
  for (const experiments::Figure& figure : results.report.figures) {
    std::cout << std::left << std::setw(64) << figure.name << ' ' << std::setw(10) << experiments::text_of(figure.value)
              << ' ' << figure.unit;
    if (figure.target)
      std::cout << "  " << experiments::verdict_on(figure) << ": " << experiments::text_of(*figure.target);
    std::cout << '\n';
  }
}

/// Who interrupts now comes too late: the files are a moment's work.
void write(const experiments::Results& results, const ExperimentOptions& given) {
  const auto interrupted = std::signal(SIGINT, SIG_IGN);
  const auto ended = std::signal(SIGTERM, SIG_IGN);
  experiments::write_results(results, given.out, given.with_scans);
  (void)std::signal(SIGINT, interrupted);
  (void)std::signal(SIGTERM, ended);
}

void run_experiment(const ExperimentOptions& given) {
  const experiments::Experiment chosen = experiment_named(given.name);
  experiments::Options options = given.options;
  const daemon::Settings settings = daemon::settings_or_defaults(given.config, given.overrides);
  options.localizer = settings.localizer;
  options.mapping = settings.mapping;
  experiments::expect_writable(given.out);
  experiments::Results results{chosen.name,          chosen.what, options.seed, options.quick,
                               chosen.runs(options), {},          {},           settings};
  std::erase_if(results.runs, [&](const experiments::Run& one) {
    return !one.is_baseline && one.name.find(given.only) == std::string::npos;
  });
  if (std::all_of(results.runs.begin(), results.runs.end(), [](const auto& one) { return one.is_baseline; }))
    throw CLI::ValidationError{"no run of '" + given.name + "' has '" + given.only + "' in its name"};
  {
    Progress progress{chosen.name, results.runs.size()};
    progress.show(0);
    const int jobs = runs_alone(chosen) ? 1 : given.jobs;
    results.outcomes = experiments::outcomes_of(results.runs, jobs, [&](std::size_t done) { progress.show(done); });
  }
  results.report = chosen.report(results.outcomes);
  write(results, given);
  if (given.as_json) {
    std::cout << experiments::summary_json(results);
  } else {
    print_summary(results);
  }
}

/// How much is done.
void add_extent(CLI::App& command, ExperimentOptions& given) {
  command.add_flag("--quick", given.options.quick, "fewer and shorter runs: to see that it works");
  command.add_option(
      "--seed", given.options.seed,
      "first seed (default 1); unseen: 1 to 999 are for development, 1000 to 1059 for final figures alone");
  command
      .add_option("--jobs", given.jobs,
                  "runs at once (default: the processors); one where an experiment measures the machine")
      ->check(CLI::Range(1, 256));
  command.add_option("--minutes", given.options.minutes, "of each drive, in place of the experiment's")
      ->check(CLI::PositiveNumber);
  command.add_option("--repeats", given.options.repeats, "seeds, or runs of each kind, in place of the experiment's")
      ->check(CLI::Range(1, 10000));
  command.add_option("--only", given.only, "only runs with this in their name, for example depot-bay");
}

/// What it is done with.
void add_inputs(CLI::App& command, ExperimentOptions& given) {
  command.add_option("--scenarios", given.options.scenarios,
                     "folder of the scenarios (default: config/scenarios, or where they are installed)");
  command.add_option("--data", given.options.data, "folder of recorded maps (default: DELTAMAP_DATA)")
      ->envname("DELTAMAP_DATA");
  command.add_option("--config", given.config, "settings of the localizer, YAML (default: as delivered)");
  command.add_option("--set", given.overrides, "key=value over the settings; repeatable")->allow_extra_args(false);
}

}  // namespace

int run_lab(int argc, const char* const* argv) {
  CLI::App command{"deltamap-lab: what is reached in simulated drives and on recorded maps, held against what is asked",
                   "deltamap-lab"};
  command.set_version_flag("--version", "deltamap-lab " + daemon::version_text());
  const auto given = std::make_shared<ExperimentOptions>();
  given->options.scenarios = scenario_folder();
  command.add_option("NAME", given->name, names_of_experiments())->required();
  command.add_option("--out", given->out, "folder for NAME.csv, summary.json and index.html")->required();
  add_extent(command, *given);
  add_inputs(command, *given);
  command.add_flag("--scans", given->with_scans, "write scans/RUN.csv too: every scan of every run");
  command.add_flag_callback(
      "--list",
      [] {
        list_experiments();
        throw CLI::Success{};
      },
      "name, 'times' where it measures the machine, and meaning of every experiment, separated by tabs");
  command.add_flag("--json", given->as_json, "print the summary as JSON");
  command.callback([given] { run_experiment(*given); });
  return answer_of(command, argc, argv);
}

}  // namespace deltamap::tool
