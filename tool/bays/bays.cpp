// SPDX-License-Identifier: Apache-2.0
// `deltamap bays MAP REC…`: what stood in the bays of a site while recordings were made; `deltamap bays import`: other
// programs' lists of places as bays.yaml.
#include <CLI/CLI.hpp>
#include <atomic>
#include <csignal>
#include <iostream>
#include <memory>

#include "core/counted.hpp"
#include "core/files/grid_file.hpp"
#include "core/files/keep_earlier.hpp"
#include "core/files/replace_file.hpp"
#include "core/files/scratch_folder.hpp"
#include "core/files/text_of_file.hpp"
#include "core/utc_text.hpp"
#include "daemon/outputs/bay_note.hpp"
#include "daemon/replay/replay_run.hpp"
#include "daemon/site/bays_file.hpp"
#include "drivers/port/port_clock.hpp"
#include "tool/bays/bay_import.hpp"
#include "tool/ctl/bays_table.hpp"
#include "tool/output_file.hpp"
#include "tool/progress.hpp"
#include "tool/subcommands.hpp"

namespace deltamap::tool {
namespace {

std::atomic<bool> bays_interrupted{false};  // by a signal: the only thing that a handler may touch
constexpr double kListPeriod_s = 1.0;       // of recorded time

struct BaysOptions {
  std::string map;
  std::vector<std::string> recordings;
  std::string bays;
  std::string config;
  std::vector<std::string> overrides;
  std::string initial_pose;
  bool as_json = false;
};

struct ImportOptions {
  std::string source;
  std::string out;
  std::string size;
  std::string map;
  std::vector<std::string> layouts;
};

/// The lines of bays.jsonl, and the states at the end.
struct BayHistory {
  std::string lines;
  std::shared_ptr<const daemon::BayList> last;
  Timestamp ended;
};

BayHistory history_of(const std::string& recording, const BaysOptions& options, const daemon::Settings& settings) {
  const ScratchFolder scratch;
  BayHistory history;
  daemon::ReplayJob job;
  job.recording = recording;
  job.map = options.map;
  job.settings = settings;
  job.out = scratch.path() / "run";
  job.warn = [](const std::string& line) { std::cerr << "deltamap: warning: " << line << '\n'; };
  job.watch.bays = [&](const daemon::BayStep& bays, Timestamp time) {
    if (history.last && seconds(time - history.ended) < kListPeriod_s) return;
    history.last = bays.list();
    history.ended = time;
  };
  constexpr std::uint64_t kSteps = 1000;
  Progress progress{"bays", kSteps};
  const daemon::RunReport report = daemon::run_replay(job, [&](double done) {
    progress.show(static_cast<std::uint64_t>(done * static_cast<double>(kSteps)));
    return !bays_interrupted;
  });
  for (const std::string& line : report.recording.lines()) std::cerr << "deltamap: warning: " << line << '\n';
  history.lines = text_of_file(job.out / "bays.jsonl");
  return history;
}

void tell_bays(BaysOptions& options) {
  if (options.map.empty() || options.recordings.empty()) throw CLI::RequiredError("MAP and REC, or 'import'");
  auto& overrides = options.overrides;
  if (!options.initial_pose.empty()) overrides.push_back("localization.initial_pose=[" + options.initial_pose + "]");
  if (!options.bays.empty()) overrides.push_back("bays.file=" + options.bays);
  const daemon::Settings settings = daemon::settings_or_defaults(options.config, overrides);
  if (settings.bays.file.empty()) throw std::runtime_error("no bays are named: give --bays FILE, or 'bays.file'");
  (void)daemon::bays_on(grid_file_geometry(options.map), settings.bays.file);
  for (const int signal : {SIGINT, SIGTERM}) std::signal(signal, [](int) { bays_interrupted = true; });
  for (const std::string& recording : options.recordings) {
    const BayHistory history = history_of(recording, options, settings);
    if (options.as_json) {
      std::cout << history.lines;
      continue;
    }
    std::cout << recording << '\n' << bay_lines(history.lines);
    if (history.last) std::cout << bays_table(daemon::json_of(*history.last, {}, history.ended));
  }
}

/// Where what stood there is kept; empty: nothing is lost.
std::string written_bays(const std::string& file, const std::string& yaml) {
  std::error_code error;
  const std::string before = std::filesystem::is_regular_file(file, error) ? text_of_file(file) : "";
  if (!before.empty() && before != yaml)
    return replace_and_keep(file, before, yaml, drivers::port::port_clock_now()).string();
  replace_file(file, yaml);
  return "";
}

void import_bays(const ImportOptions& options) {
  require_output_beside(options.out, options.source);
  const auto size = options.size.empty() ? std::nullopt : std::optional{bay_size_in(options.size)};
  const ImportedBays imported = imported_bays(options.source, size, options.layouts);
  daemon::require_sound_bays(imported.bays, options.source);
  if (!options.map.empty()) daemon::require_bays_on(grid_file_geometry(options.map), imported.bays, options.source);
  const std::string kept = written_bays(options.out, daemon::bays_as_yaml(imported.bays));
  for (const std::string& line : imported.left_out) std::cerr << "deltamap: warning: " << line << '\n';
  std::cout << options.out << ": " << counted(imported.bays.size(), "bay")
            << (kept.empty() ? "" : "; what stood there is kept in " + kept) << '\n';
}

void add_bays_import(CLI::App& bays) {
  auto options = std::make_shared<ImportOptions>();
  CLI::App* command = bays.add_subcommand("import", "stations of a LIF 1.0 file, or a table, as bays.yaml");
  command->add_option("FILE", options->source, "LIF (.lif, .json) or table (.csv)")->required();
  command->add_option("--out", options->out, "bays.yaml to write")->required();
  command->add_option("--size", options->size, "ALONGxACROSS of bays that tell no size, m: 2.4x1.2");
  command->add_option("--map", options->map, "map that all of them must lie on");
  command->add_option("--layout", options->layouts, "layoutId of a LIF file whose stations are read; repeatable")
      ->allow_extra_args(false);
  command->callback([options] { import_bays(*options); });
}

}  // namespace

void add_bays(CLI::App& app) {
  auto options = std::make_shared<BaysOptions>();
  CLI::App* command = app.add_subcommand("bays", "what stood in the bays of a site while recordings were made");
  command->add_option("MAP", options->map, "M_0, map_server YAML");
  command->add_option("REC", options->recordings, "pcapng recordings");
  command->add_option("--bays", options->bays, "bays.yaml; over 'bays.file' of the settings");
  command->add_option("--config", options->config, "settings, YAML; as delivered where it is not given");
  command->add_option("--initial-pose", options->initial_pose,
                      "X,Y,DEG of the robot in the map at the first scan; over the settings' pose");
  command->add_option("--set", options->overrides, "key=value over the settings; repeatable")->allow_extra_args(false);
  command->add_flag("--json", options->as_json, "the lines of bays.jsonl");
  command->require_subcommand(0, 1);
  add_bays_import(*command);
  command->callback([options, command] {
    if (command->get_subcommands().empty()) tell_bays(*options);
  });
}

}  // namespace deltamap::tool
