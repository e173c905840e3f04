// SPDX-License-Identifier: Apache-2.0
#include "daemon/run_daemon.hpp"

#include <spdlog/sinks/stdout_color_sinks.h>
#include <spdlog/spdlog.h>
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <atomic>
#include <cerrno>
#include <csignal>
#include <iostream>
#include <memory>
#include <mutex>
#include <optional>
#include <system_error>

#include "core/files/file_lock.hpp"
#include "core/files/grid_file.hpp"
#include "daemon/check_config.hpp"
#include "daemon/console.hpp"
#include "daemon/control/server.hpp"
#include "daemon/first_map.hpp"
#include "daemon/kept/kept_pose.hpp"
#include "daemon/kept/kept_stability.hpp"
#include "daemon/maps/newest_map.hpp"
#include "daemon/maps/store_opening.hpp"
#include "daemon/outputs/output_place.hpp"
#include "daemon/outputs/outputs.hpp"
#include "daemon/outputs/state_folders.hpp"
#include "daemon/pipeline.hpp"
#include "daemon/settings/memory_places.hpp"
#include "daemon/settings/settings.hpp"
#include "daemon/settings/settings_documents.hpp"
#include "daemon/settings/settings_reading.hpp"
#include "daemon/settings/start_error.hpp"
#include "daemon/start_banner.hpp"
#include "daemon/system/service.hpp"
#include "daemon/system/stop_signals.hpp"
#include "daemon/telemetry/version.hpp"
#include "mapping/store/store_error.hpp"

namespace deltamap::daemon {
namespace {

constexpr double kStuck_s = 10.0;  // a stage that is silent for so long (map and recorder: 100 s) has hung

struct CommandLine {
  std::string config;
  std::vector<std::string> overrides;
  std::string out;
  std::string initial_pose;
  bool check_only = false;
  bool print_only = false;
};

void print(const std::string& text) {
  if (!(std::cout << text).flush()) throw std::runtime_error("standard output: cannot be written");
}

void add_options(CLI::App& app, CommandLine& line) {
  app.set_version_flag("--version", "deltamapd " + version_text());
  app.add_option("--config", line.config, "settings, YAML")->required();
  app.add_option("--set", line.overrides, "key=value over the settings; repeatable")->allow_extra_args(false);
  app.add_option("--out", line.out, "also write trajectory.tum, map, changes.jsonl and report.json into this folder");
  app.add_option("--initial-pose", line.initial_pose, "X,Y,DEG of the robot in the map at the first scan");
  auto* check = app.add_flag("--check-config", line.check_only, "look at settings, map, store and ports, and end");
  app.add_flag("--print-config", line.print_only, "print all settings with their values and end")->excludes(check);
  const auto prints = [&app](const std::string& name, std::string (*text)(), const std::string& what) {
    const auto print_and_end = [text] {
      print(text());
      throw CLI::Success();
    };
    app.add_flag_callback(name, print_and_end, what);
  };
  prints("--print-schema", settings_schema, "print the JSON schema of the settings, for editors, and end");
  prints("--print-configuration-md", settings_page, "print the table of all settings (Markdown) and end");
}

void tell_start(const Settings& settings, const CommandLine& line, const StartMap& start, Console& console) {
  const auto revision = settings.map.store.empty() ? std::nullopt : std::optional{start.revision};
  for (const std::string& text : start_banner(settings, line.config, start.map->geometry(), revision)) {
    console.log(LogLevel::kInfo, text);
  }
}

/// Where the run before has left the robot, and what it has learned of wheels and mount; a pose that a person gave goes
/// before its pose.
void remember_pose(const Settings& settings, Pipeline::Options& options, Console& console) {
  const auto answer = read_kept_pose(memory_places(settings.map.store).pose, options.first_map);
  options.start.calibration = answer.calibration;
  options.memory ^= answer.fingerprint;
  if (settings.initial_pose) return;
  if (!answer.why_not.empty()) console.log(LogLevel::kWarn, "no pose to begin with: " + answer.why_not);
  if (!answer.pose) return;
  options.start.remembered = answer.pose->map_from_robot;
  console.log(LogLevel::kInfo, begin_line(*answer.pose));
}

/// Takes the stability that earlier runs have learned, without that of cells that were rewritten since.
void remember_stability(const Settings& settings, const mapping::store::MapStore& store, Pipeline::Options& options,
                        Console& console) {
  auto answer = read_kept_stability(memory_places(settings.map.store).stability, options.first_map);
  if (!answer.why_not.empty()) console.log(LogLevel::kWarn, "stability is earned anew: " + answer.why_not);
  if (!answer.kept) return;
  std::vector<CellChange> changes;
  try {
    changes = changes_between(store.grid(answer.kept->revision), *options.start.map);
  } catch (const mapping::store::StoreError& error) {
    console.log(LogLevel::kWarn, std::string("stability is earned anew: ") + error.what());
    return;
  }
  options.start.stability = without(answer.kept->record, changes);
  options.memory ^= answer.fingerprint;
}

void reload(Pipeline& pipeline) {
  service::tell_reloading();
  (void)pipeline.reload();  // the log has what came of it
  service::tell_ready();
}

/// Until a signal to stop comes, or a stage fails. `hangup_reloads`: SIGHUP is no reason to stop.
void watch(Pipeline& pipeline, Console& console, bool hangup_reloads) {
  const sigset_t signals = stop_signals();
  const timespec second{1, 0};
  for (;;) {
    const int signal = sigtimedwait(&signals, nullptr, &second);
    if (signal == SIGHUP && hangup_reloads) {
      reload(pipeline);
    } else if (signal > 0) {
      return;
    }
    const std::string status = status_line(pipeline.telemetry());
    console.show(status);
    service::tell_status(status);
    if (const Pipeline::Silence longest = pipeline.longest_silence(); longest.silence_s < kStuck_s) {
      service::feed_watchdog();
    } else {
      console.log(LogLevel::kError, "watchdog is not fed: stage=" + std::string(longest.stage) + " does not move");
    }
  }
}

OccupancyGrid first_map(const Settings& settings, const CommandLine& line, Console& console) {
  require_map_named(settings, line.config);
  constexpr std::uint64_t kReadInAMoment = 20'000'000;  // cells: within half a second
  try {
    if (grid_file_geometry(settings.map.file).cell_count() > kReadInAMoment)
      console.log(LogLevel::kInfo, "reads the map: " + settings.map.file);
    FirstMap map = read_first_map(settings.map.file, memory_limit());
    for (const std::string& warning : map.warnings) console.log(LogLevel::kWarn, warning);
    return std::move(map.grid);
  } catch (const MemoryShortage&) {
    throw;
  } catch (const std::runtime_error& error) {
    throw StartError(error.what());
  }
}

/// Made where there is none.
std::filesystem::path folder_to_write(const std::string& out, const Settings& settings) {
  std::error_code error;
  std::filesystem::create_directories(out, error);
  if (error) {
    const std::string why = why_no_folder_for(std::filesystem::path(out) / "report.json");
    throw StartError(out + ": cannot be made: " + (why.empty() ? error.message() : why));
  }
  (void)judged_out_place(out, settings);
  return out;
}

/// The store and what an earlier run has left beside it.
void take_store(OpenedStore& opened, const Settings& settings, Pipeline::Options& options, Console& console) {
  for (const std::string& warning : opened.warnings) console.log(LogLevel::kWarn, warning);
  if (options.start.revision > 0) {
    console.log(LogLevel::kInfo, "map store: goes on with revision=" + std::to_string(options.start.revision));
  }
  remember_pose(settings, options, console);
  if (opened.store.store) remember_stability(settings, *opened.store.store, options, console);
  options.store = std::move(opened.store);
}

/// Begins the pipeline; a mistake in settings or map that only its stages find ends the start as any other one does.
std::unique_ptr<Pipeline> begun(const Settings& settings, Pipeline::Options options) {
  try {
    return std::make_unique<Pipeline>(settings, std::move(options));
  } catch (const sockets::AlreadyServed&) {
    throw;
  } catch (const FileInUse&) {
    throw;
  } catch (const std::system_error&) {
    throw;
  } catch (const std::runtime_error& error) {
    throw StartError(error.what());
  }
}

void tell(const std::vector<std::string>& problems) {
  for (const std::string& problem : problems) std::cerr << "deltamapd: " << problem << '\n';
}

/// --check-config
int check(const CommandLine& line) {
  const SettingsReading reading = look_at_settings(line.config, line.overrides);
  tell(reading.problems);
  const auto findings = reading.problems.empty() ? check_config(reading.settings, line.config, line.out)
                                                 : check_what_is_read(reading, line.config);
  print(text_of(findings));
  return has_error(findings) ? 2 : 0;
}

/// What a running daemon reads again: a pipe, or a disk's worth of text, would hold it up.
void require_plain_file(const std::filesystem::path& settings) {
  constexpr std::uintmax_t kLargest = 1'000'000;
  std::error_code error;
  const std::filesystem::file_status status = std::filesystem::status(settings, error);
  if (!std::filesystem::exists(status)) return;  // its reader says why
  if (!std::filesystem::is_regular_file(status) || std::filesystem::file_size(settings, error) > kLargest) {
    throw SettingsError(settings.string() + ": is no plain file of at most 1 MB");
  }
}

/// A file that no start would accept is no good for a running daemon either. What takes long to know is left out.
void require_a_start(const Settings& read, const std::string& config) {
  require_map_named(read, config);
  try {
    require_pose_on(grid_file_geometry(read.map.file), read);
    require_newest_named(read.map);
  } catch (const SettingsError&) {
    throw;
  } catch (const std::runtime_error& error) {
    throw SettingsError(error.what());
  }
}

/// The settings of the run, to be read again while it goes on.
std::shared_ptr<LiveSettings> live_settings(const SettingsReading& reading, const CommandLine& line) {
  return std::make_shared<LiveSettings>(reading, [line] {
    require_plain_file(line.config);
    SettingsReading read = read_settings_of_a_run(line.config, line.overrides);
    require_a_start(read.settings, line.config);
    return read;
  });
}

/// Another daemon's folder of incidents ends the start before anything is made. One that cannot be is told later, again
/// and again, and ends nothing.
void require_own_incidents(const Settings& settings) {
  if (settings.incidents.folder.empty()) return;
  try {
    require_lockable_folder(settings.incidents.folder);
  } catch (const std::system_error&) {
  }
}

/// Reads and opens what the run begins from, makes the folders that it writes to, and says so.
Pipeline::Options prepared(const SettingsReading& reading, const CommandLine& line, Console& console) {
  const Settings& settings = reading.settings;
  Pipeline::Options options;
  options.live = live_settings(reading, line);
  const OccupancyGrid first = first_map(settings, line, console);
  options.first_map = grid_hash(first);
  require_pose_on(first.geometry(), settings);
  if (const std::string doubt = doubt_of_pose(first, settings); !doubt.empty()) console.log(LogLevel::kWarn, doubt);
  options.start.map = std::make_shared<const OccupancyGrid>(first);
  require_own_incidents(settings);
  make_state_folders(settings, line.config);
  if (!line.out.empty()) options.out = folder_to_write(line.out, settings);
  std::optional<OpenedStore> store;
  if (!settings.map.store.empty()) store = open_store(settings.map.store, first);
  if (store) options.start = std::move(store->start);
  tell_start(settings, line, options.start, console);
  if (store) take_store(*store, settings, options, console);
  return options;
}

/// What the stages have to say goes to the console; a stage that ends by an exception ends the run.
void hear(Pipeline::Options& options, Console& console, std::atomic<bool>& failed) {
  options.log = [&console](const std::string& text) { console.log(LogLevel::kInfo, text); };
  options.failed = [&console, &failed](const std::string& text) {
    console.log(LogLevel::kError, text);
    failed = true;
    (void)kill(getpid(), SIGTERM);
  };
  options.warn = [&console](const std::string& text) { console.log(LogLevel::kWarn, text); };
  options.set_log_level = [](LogLevel level) { Console::set_level(level); };
}

int run_pipeline(const SettingsReading& reading, const CommandLine& line) {
  Console console;
  const bool hangup_reloads = !has_terminal();
  take_signals();  // all threads begin with them blocked: only watch() takes them

  Pipeline::Options options = prepared(reading, line, console);
  std::atomic<bool> failed{false};
  hear(options, console, failed);
  const std::unique_ptr<Pipeline> pipeline = begun(reading.settings, std::move(options));
  service::tell_ready();
  watch(*pipeline, console, hangup_reloads);
  service::tell_stopping();
  console.end();
  const RunReport report = pipeline->stop();
  console.log(LogLevel::kInfo, "stopped: scans=" + std::to_string(report.scans.decoded) + " phases=" +
                                   std::to_string(report.phases) + " cpu_s=" + std::to_string(report.cpu_total_s));
  return failed ? 1 : 0;
}

}  // namespace

int run_daemon(int argc, const char* const* argv) {
  CommandLine line;
  CLI::App app{"deltamapd: keeps a robot localized in a map that follows the world", "deltamapd"};
  add_options(app, line);
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? 0 : 2;
  } catch (const std::runtime_error& error) {
    std::cerr << "deltamapd: " << error.what() << '\n';
    return 1;
  }
  spdlog::set_default_logger(spdlog::stderr_color_mt("deltamapd"));
  spdlog::set_pattern("%H:%M:%S.%e %^%l%$ %v");
  try {
    if (!line.initial_pose.empty()) line.overrides.push_back("localization.initial_pose=[" + line.initial_pose + "]");
    if (line.check_only) return check(line);
    if (line.print_only) {
      print(settings_as_yaml(read_settings(line.config, line.overrides)));
      return 0;
    }
    return run_pipeline(read_settings_of_a_run(line.config, line.overrides), line);
  } catch (const SettingsError& error) {
    tell(error.lines());
    return 2;
  } catch (const StartError& error) {
    std::cerr << "deltamapd: " << error.what() << '\n';
    return 2;
  } catch (const std::exception& error) {
    std::cerr << "deltamapd: " << error.what() << '\n';
    return 1;
  }
}

}  // namespace deltamap::daemon
