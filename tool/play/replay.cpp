// SPDX-License-Identifier: Apache-2.0
// `deltamap replay`: the whole pipeline on recorded bytes, as fast as it can; or the recorded devices for another
// client.
#include <CLI/CLI.hpp>
#include <atomic>
#include <csignal>
#include <iostream>
#include <memory>

#include "core/counted.hpp"
#include "daemon/replay/replay_run.hpp"
#include "tool/play/play_recording.hpp"
#include "tool/progress.hpp"
#include "tool/subcommands.hpp"

namespace deltamap::tool {
namespace {

std::atomic<bool> interrupted{false};  // by a signal: the only thing that a handler may touch

struct ReplayOptions {
  daemon::ReplayJob job;
  std::string config;
  std::vector<std::string> overrides;
  std::string initial_pose;
  std::optional<std::int64_t> seed;
  std::string to_pty;
  bool as_json = false;
};

void print_summary(const daemon::RunReport& report) {
  const double scans = static_cast<double>(report.scans.decoded);
  const std::string differences =
      report.journal_differences == 0 ? "" : " with " + counted(report.journal_differences, "difference");
  std::cout << counted(report.scans.decoded, "scan") << ", " << counted(report.phases, "delta phase") << ", "
            << counted(report.changes.accepted(), "revision") << ", " << report.changes.refused() << " refused, lost "
            << report.time_lost_s << " s, " << report.cpu_total_s / scans * 1e3 << " ms CPU a scan, peak "
            << static_cast<double>(report.peak_resident_bytes) / (1024.0 * 1024.0) << " MB, journal " << report.journal
            << differences << "; began with " << report.began << '\n';
}

void run_replay(ReplayOptions& options) {
  auto& overrides = options.overrides;
  if (!options.initial_pose.empty()) overrides.push_back("localization.initial_pose=[" + options.initial_pose + "]");
  if (options.seed) overrides.push_back("seed=" + std::to_string(*options.seed));
  options.job.settings = daemon::settings_or_defaults(options.config, overrides);
  for (const int signal : {SIGINT, SIGTERM}) std::signal(signal, [](int) { interrupted = true; });
  options.job.warn = [](const std::string& line) { std::cerr << "deltamap: warning: " << line << '\n'; };
  daemon::RunReport report;
  {
    constexpr std::uint64_t kSteps = 1000;
    Progress progress{"replay", kSteps};
    report = daemon::run_replay(options.job, [&](double done) {
      progress.show(static_cast<std::uint64_t>(done * static_cast<double>(kSteps)));
      return !interrupted;
    });
  }
  for (const std::string& line : report.recording.lines()) std::cerr << "deltamap: warning: " << line << '\n';
  if (options.as_json)
    std::cout << daemon::json_text(report, daemon::settings_that_ran(options.job));
  else
    print_summary(report);
}

void replay_or_play(ReplayOptions& options) {
  const daemon::ReplayJob& job = options.job;
  if (!options.to_pty.empty()) return play_recording(job.recording, options.to_pty, {job.from_s, job.to_s});
  if (job.map.empty()) throw CLI::RequiredError("--map");
  if (job.out.empty()) throw CLI::RequiredError("--out");
  run_replay(options);
}

}  // namespace

void add_replay(CLI::App& app) {
  auto* command = app.add_subcommand("replay", "the whole pipeline on recorded bytes, as fast as it can");
  auto options = std::make_shared<ReplayOptions>();
  command->add_option("RECORDING", options->job.recording, "pcapng of both ports")->required();
  command->add_option("--map", options->job.map, "M_0, map_server YAML; required, as is --out, but with --to-pty");
  command->add_option("--config", options->config, "settings, YAML; as delivered where it is not given");
  command->add_option("--out", options->job.out, "folder for trajectory.tum, map, changes.jsonl, report.json");
  CLI::Option* const to_pty = command->add_option(
      "--to-pty", options->to_pty,
      "play the recorded devices in real time on two pseudo-terminals, linked as robot and laser in this "
      "folder, and tell where their client says something else than was recorded");
  command->add_option("--seed", options->seed, "over the settings' seed");
  command->add_option("--initial-pose", options->initial_pose,
                      "X,Y,DEG of the robot in the map at the first scan; over the settings' pose");
  command->add_option("--from", options->job.from_s, "seconds after the first byte to begin at")
      ->check(CLI::NonNegativeNumber);
  command->add_option("--to", options->job.to_s, "seconds after the first byte to end at")
      ->check(CLI::NonNegativeNumber);
  command
      ->add_option("--map-delay", options->job.map_delay_s,
                   "seconds from the end of a delta phase until its revision is taken, without a journal")
      ->check(CLI::NonNegativeNumber);
  command->add_option("--set", options->overrides, "key=value over the settings; repeatable")->allow_extra_args(false);
  command->add_flag("--json", options->as_json, "print the report as JSON");
  for (const char* unheeded :
       {"--map", "--config", "--out", "--seed", "--initial-pose", "--map-delay", "--set", "--json"})
    to_pty->excludes(command->get_option(unheeded));
  command->callback([options] { replay_or_play(*options); });
}

}  // namespace deltamap::tool
