// SPDX-License-Identifier: Apache-2.0
// `deltamap view`: a run's folder, a recording or a map in the page, to be looked at and scrubbed.
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <atomic>
#include <csignal>
#include <filesystem>
#include <iostream>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

#include "core/files/scratch_folder.hpp"
#include "daemon/incidents/incident.hpp"
#include "daemon/replay/incident_replay.hpp"
#include "daemon/replay/replay_run.hpp"
#include "daemon/replay/replay_start.hpp"
#include "tool/subcommands.hpp"
#include "tool/told_grid.hpp"
#include "tool/view/run_folder.hpp"
#include "tool/view/view.hpp"
#include "tool/view/view_desk.hpp"

namespace deltamap::tool {
namespace {

namespace fs = std::filesystem;

struct ViewOptions {
  fs::path target;
  std::uint16_t port = 0;
  daemon::ReplayJob job;
  std::string config;
  std::vector<std::string> overrides;
  std::string initial_pose;
};

void warn(const std::string& line) { std::cerr << "deltamap: warning: " << line << '\n'; }

/// Reads what is to be viewed into the desk; answers a note, or nothing where it was told to stop.
using Reading = std::function<std::optional<std::string>(ViewDesk&, const std::atomic<bool>& stops)>;

sigset_t ending_signals() {
  sigset_t signals;
  sigemptyset(&signals);
  for (const int signal : {SIGINT, SIGTERM, SIGHUP}) sigaddset(&signals, signal);
  return signals;
}

/// Serves until a signal to end comes. What goes wrong while reading ends it too, and is thrown.
void serve(ViewDesk& desk, const Reading& reading) {
  const sigset_t signals = ending_signals();
  (void)pthread_sigmask(SIG_BLOCK, &signals, nullptr);
  std::atomic<bool> stops{false};
  std::exception_ptr failure;
  std::jthread page{[&] { desk.run(); }};
  std::jthread reader{[&] {
    try {
      if (const auto note = reading(desk, stops)) desk.tell_complete(*note);
    } catch (...) {
      failure = std::current_exception();
      (void)::kill(::getpid(), SIGTERM);
    }
  }};
  std::cout << desk.url() << std::endl;
  int signal = 0;
  (void)sigwait(&signals, &signal);
  stops = true;
  reader.join();
  desk.stop();
  page.join();
  if (failure) std::rethrow_exception(failure);
}

void view_map(const ViewOptions& options) {
  ViewedRun run{.kind = "map", .name = options.target.filename().string()};
  run.map = std::make_shared<const OccupancyGrid>(told_grid(options.target));
  ViewDesk desk{std::move(run), options.port};
  serve(desk, [](ViewDesk&, const std::atomic<bool>&) { return std::string{}; });
}

void view_folder(const ViewOptions& options) {
  const fs::path folder = fs::absolute(options.target).lexically_normal();
  const RunFolder read = read_run_folder(folder);
  for (const std::string& note : read.notes) warn(note);
  ViewedRun run{.kind = "folder", .name = (folder.has_filename() ? folder : folder.parent_path()).filename().string()};
  run.settings = read.settings;
  run.map = std::make_shared<const OccupancyGrid>(told_grid(folder / "map.yaml"));
  run.first_revision = read.rows.front().revision;
  run.revision = run.first_revision;
  for (const daemon::ChangeNote& change : read.changes)
    run.revision = std::max(run.revision, change.revision.value_or(0));
  if (fs::exists(folder / "map_store.sqlite")) run.store = folder / "map_store.sqlite";
  run.things = folder / "things.jsonl";
  ViewDesk desk{std::move(run), options.port};
  serve(desk, [&read](ViewDesk& to, const std::atomic<bool>& stops) -> std::optional<std::string> {
    for (const daemon::ChangeNote& change : read.changes) to.show(nullptr, change);
    for (std::size_t i = 0; i < read.rows.size() && !stops; ++i) {
      to.show(read.rows[i]);
      to.tell_progress(static_cast<double>(i) / static_cast<double>(read.rows.size()));
    }
    return stops ? std::nullopt : std::optional{read.notes.empty() ? "" : read.notes.front()};
  });
}

/// Replays the job and tells how far it is; answers a note on the recording, or nothing where it was told to stop.
std::optional<std::string> replayed(const daemon::ReplayJob& job, ViewDesk& desk, const std::atomic<bool>& stops) {
  try {
    const daemon::RunReport report = daemon::run_replay(job, [&](double done) {
      desk.tell_progress(done);
      return !stops;
    });
    const std::vector<std::string> lines = report.recording.lines();
    return lines.empty() ? "" : lines.front();
  } catch (const std::runtime_error&) {
    if (stops) return std::nullopt;
    throw;
  }
}

/// Replays the job into the page.
void view_replay(daemon::ReplayJob job, const std::string& name, std::uint16_t port,
                 const daemon::Incident* incident = nullptr) {
  const ScratchFolder scratch;
  job.out = scratch.path() / "run";
  auto given = std::make_shared<const OccupancyGrid>(told_grid(job.map));
  const daemon::RecordedRun recorded = daemon::recorded_run(job);
  const daemon::StartMap start = daemon::replay_start(recorded, job, std::move(given)).start;
  for (const std::string& line : recorded.faults.lines()) warn(line);
  ViewDesk desk{{.kind = "recording",
                 .name = name,
                 .settings = job.settings,
                 .map = start.map,
                 .revision = start.revision,
                 .first_revision = start.revision,
                 .store = job.out / "map_store.sqlite",
                 .things = job.out / "things.jsonl"},
                port};
  desk.events().add_orders(recorded.journal.commands());
  if (incident != nullptr) desk.events().add(*incident);
  job.watch.scan = [&desk](const daemon::ReplayedScan& scan) { desk.show(scan); };
  job.watch.change = [&desk](const MapRevision* revision, const daemon::ChangeNote& note) {
    desk.show(revision, note);
  };
  serve(desk, [&job](ViewDesk& to, const std::atomic<bool>& stops) { return replayed(job, to, stops); });
}

/// The settings of the replay: nobody steers it.
daemon::Settings settings_of(const ViewOptions& options) {
  std::vector<std::string> overrides = options.overrides;
  if (!options.initial_pose.empty()) overrides.push_back("localization.initial_pose=[" + options.initial_pose + "]");
  daemon::Settings settings = daemon::settings_or_defaults(options.config, overrides);
  settings.dashboard.control = false;
  return settings;
}

void view_recording(const ViewOptions& options) {
  if (options.job.map.empty()) {
    throw std::runtime_error(options.target.string() + ": a recording needs --map, as `deltamap replay` does");
  }
  daemon::ReplayJob job = options.job;
  job.settings = settings_of(options);
  job.recording = options.target;
  view_replay(std::move(job), options.target.filename().string(), options.port);
}

void view(const ViewOptions& options) {
  std::error_code error;
  const fs::file_status status = fs::status(options.target, error);
  if (!fs::exists(status)) {
    throw std::runtime_error(options.target.string() + ": " +
                             std::generic_category().message(error ? error.value() : ENOENT));
  }
  const std::string extension = options.target.extension().string();
  if (fs::exists(options.target / daemon::kIncidentFacts)) return view_incident(options.target, options.port);
  if (fs::is_directory(status)) return view_folder(options);
  if (extension == ".yaml" || extension == ".yml" || extension == ".pgm") return view_map(options);
  view_recording(options);
}

}  // namespace

void view_incident(const fs::path& folder, std::uint16_t port) {
  const daemon::Incident incident = daemon::read_incident(folder);
  daemon::ReplayJob job = daemon::incident_job(folder);
  job.settings.dashboard.control = false;
  view_replay(std::move(job), incident.name, port, &incident);
}

void add_view(CLI::App& app) {
  auto* command = app.add_subcommand("view", "a run's folder, a recording or a map in a browser, to be scrubbed");
  auto options = std::make_shared<ViewOptions>();
  command
      ->add_option("SOURCE", options->target,
                   "folder of a run (--out) or an incident, recording (pcapng), or map (YAML)")
      ->required();
  command->add_option("--port", options->port, "of the page, on loopback; 0 (as delivered): any that is free");
  command->add_option("--map", options->job.map, "of a recording: M_0, map_server YAML");
  command->add_option("--config", options->config,
                      "of a recording: settings, YAML; as delivered where it is not given");
  command->add_option("--set", options->overrides, "of a recording: key=value over the settings; repeatable")
      ->allow_extra_args(false);
  command->add_option("--initial-pose", options->initial_pose,
                      "of a recording: X,Y,DEG of the robot in the map at the first scan; over the settings' pose");
  command->add_option("--from", options->job.from_s, "of a recording: seconds after the first byte to begin at")
      ->check(CLI::NonNegativeNumber);
  command->add_option("--to", options->job.to_s, "of a recording: seconds after the first byte to end at")
      ->check(CLI::NonNegativeNumber);
  command->callback([options] { view(*options); });
}

}  // namespace deltamap::tool
