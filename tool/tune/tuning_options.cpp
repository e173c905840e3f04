// SPDX-License-Identifier: Apache-2.0
#include "tool/tune/tuning_options.hpp"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <atomic>
#include <cctype>
#include <cmath>
#include <csignal>
#include <iostream>
#include <set>
#include <stdexcept>
#include <thread>

namespace deltamap::tool::tune {
namespace {

std::atomic<bool> ended{false};  // by a signal: the only thing that its handler may touch

/// What is given once is of all; "-" is none.
std::string of_drive(const std::vector<std::string>& given, std::size_t drive, std::size_t drives,
                     const std::string& option) {
  if (given.empty()) return "";
  if (given.size() != 1 && given.size() != drives) {
    throw daemon::SettingsError(option + ": is given " + std::to_string(given.size()) + " times for " +
                                std::to_string(drives) + " recordings: once for all, or once for each ('-' for none)");
  }
  const std::string& own = given.size() == 1 ? given.front() : given[drive];
  return own == "-" ? "" : own;
}

/// Of "2:key=value" the number; 0 where the text is of all drives.
std::size_t drive_of_override(const std::string& text) {
  const std::size_t colon = text.find(':');
  const bool is_numbered = colon != std::string::npos && colon > 0 && colon < text.find('=') &&
                           std::all_of(text.begin(), text.begin() + static_cast<std::ptrdiff_t>(colon),
                                       [](unsigned char c) { return std::isdigit(c) != 0; });
  return is_numbered ? std::stoul(text.substr(0, std::min<std::size_t>(colon, 9))) : 0;
}

std::vector<std::string> overrides_of(const TuningOptions& options, std::size_t drive) {
  std::vector<std::string> own;
  for (const std::string& text : options.overrides) {
    const std::size_t number = drive_of_override(text);
    if (number > options.recordings.size() || text.starts_with("0:")) {
      throw daemon::SettingsError("--set " + text + ": there are " + std::to_string(options.recordings.size()) +
                                  " recordings, counted from 1");
    }
    if (number == 0) own.push_back(text);
    if (number == drive + 1) own.push_back(text.substr(text.find(':') + 1));
  }
  const std::string pose = of_drive(options.poses, drive, options.recordings.size(), "--initial-pose");
  if (!pose.empty()) own.push_back("localization.initial_pose=[" + pose + "]");
  return own;
}

/// The file's name, with a number where that is taken.
std::string name_of(const std::string& recording, std::set<std::string>& taken) {
  const std::string stem = std::filesystem::path(recording).stem().string();
  std::string name = stem;
  for (int number = 2; !taken.insert(name).second; ++number) name = stem + "-" + std::to_string(number);
  return name;
}

/// Why no run of a recording with this true way gives the measure; empty: all do.
std::string why_not_given(TrueWay::Kind kind, std::string_view measure) {
  using Kind = TrueWay::Kind;
  const bool is_of_poses = measure.starts_with("error_") || measure == "heading_median_deg" || measure == "lost_share";
  if (is_of_poses && kind != Kind::kReference && kind != Kind::kSimulation) return "needs --reference or --truth";
  if (measure.starts_with("relation_") && kind != Kind::kRelations) return "needs --relations";
  return measure == "repeatability_m" ? "is of several runs at once: `deltamap score` alone tells it" : "";
}

}  // namespace

TrueWay true_way_of(const TuningOptions& options, std::size_t drive) {
  const std::size_t drives = options.recordings.size();
  TrueWay way;
  const auto look = [&](TrueWay::Kind kind, const std::vector<std::string>& given, const std::string& option) {
    const std::string file = of_drive(given, drive, drives, option);
    if (file.empty()) return;
    if (way.kind != TrueWay::Kind::kNone)
      throw daemon::SettingsError(option + ": a recording has one true way: --reference, --relations or --truth");
    way = {kind, file, options.of_laser && kind == TrueWay::Kind::kReference};
  };
  look(TrueWay::Kind::kReference, options.references, "--reference");
  look(TrueWay::Kind::kRelations, options.relations, "--relations");
  look(TrueWay::Kind::kSimulation, options.truths, "--truth");
  return way;
}

std::filesystem::path map_of(const TuningOptions& options, std::size_t drive) {
  return of_drive(options.maps, drive, options.recordings.size(), "--map");
}

void add_tuning_options(CLI::App& command, TuningOptions& options) {
  command
      .add_option("--map", options.maps,
                  "M_0, map_server YAML; once for all recordings, or once for each in their order")
      ->allow_extra_args(false);
  command.add_option("--reference", options.references, "true poses, TUM or t x y theta; as --map, '-' for none")
      ->allow_extra_args(false);
  command.add_flag("--of-laser", options.of_laser, "the references tell poses of the laser, not of the robot");
  command.add_option("--relations", options.relations, "measured relations; as --reference")->allow_extra_args(false);
  command.add_option("--truth", options.truths, "what deltamap sim --truth wrote; as --reference")
      ->allow_extra_args(false);
  command.add_option("--initial-pose", options.poses, "X,Y,DEG of the robot at the first scan; as --reference")
      ->allow_extra_args(false);
  command
      .add_option("--set", options.overrides, "key=value over the settings; N:key=value for the Nth recording alone")
      ->allow_extra_args(false);
  command.add_option("--from", options.from_s, "seconds after the first byte to begin at")
      ->check(CLI::NonNegativeNumber);
  command.add_option("--to", options.to_s, "seconds after the first byte to end at")->check(CLI::NonNegativeNumber);
  command.add_option("--jobs", options.jobs, "runs at a time (default: as many as there are processors)")
      ->check(CLI::Range(1, 1024));
  command.add_flag("--json", options.as_json, "print JSON");
}

Drives drives_of(const TuningOptions& options) {
  Drives drives;
  std::set<std::string> taken;
  const std::size_t count = options.recordings.size();
  for (std::size_t i = 0; i < count; ++i) {
    DriveFiles files{.name = name_of(options.recordings[i], taken), .recording = options.recordings[i]};
    files.map = map_of(options, i);
    if (files.map.empty())
      throw daemon::SettingsError(options.recordings[i] + ": a recording needs --map, as `deltamap replay` does");
    files.way = true_way_of(options, i);
    files.overrides = overrides_of(options, i);
    files.from_s = options.from_s;
    files.to_s = options.to_s;
    drives.push_back(std::make_unique<TunedDrive>(std::move(files)));
  }
  return drives;
}

Variant variant_of(const std::string& name, const std::string& config,
                   const std::vector<std::pair<std::string, std::string>>& values, const Drives& drives) {
  Variant variant{name, values};
  for (const auto& drive : drives) {
    std::vector<std::string> overrides = drive->files().overrides;
    for (const auto& [key, value] : values) overrides.push_back(std::string(key).append("=").append(value));
    variant.settings.push_back(daemon::settings_or_defaults(config, overrides));
  }
  return variant;
}

std::vector<std::uint64_t> seeds_from(std::uint64_t first, int count) {
  std::vector<std::uint64_t> seeds;
  seeds.reserve(static_cast<std::size_t>(std::max(0, count)));
  for (int i = 0; i < count; ++i) seeds.push_back(first + static_cast<std::uint64_t>(i));
  return seeds;
}

int jobs_of(const TuningOptions& options) {
  return options.jobs > 0 ? options.jobs : static_cast<int>(std::max(1U, std::thread::hardware_concurrency()));
}

const Measure& deciding_measure(const TuningOptions& options, const Drives& drives, bool needs_all) {
  if (!options.by.empty()) {
    const Measure& asked = measure_named(options.by);
    const auto has_it = [&](const auto& drive) { return why_not_given(drive->files().way.kind, asked.name).empty(); };
    const auto count = static_cast<std::size_t>(std::count_if(drives.begin(), drives.end(), has_it));
    if (count > 0 && (count == drives.size() || !needs_all)) return asked;
    const auto without = std::find_if_not(drives.begin(), drives.end(), has_it);
    throw daemon::SettingsError(
        "--by " + options.by + ": " + why_not_given((*without)->files().way.kind, asked.name) +
        (count > 0 ? " for every recording, and " + (*without)->files().name + " has none" : ""));
  }
  const auto all_have = [&](auto... kinds) {
    return std::all_of(drives.begin(), drives.end(),
                       [&](const auto& drive) { return ((drive->files().way.kind == kinds) || ...); });
  };
  using Kind = TrueWay::Kind;
  if (all_have(Kind::kReference, Kind::kSimulation)) return measure_named("error_rmse_m");
  return measure_named(all_have(Kind::kRelations) ? "relation_m" : "agreement");
}

std::function<bool()> watch_for_interrupt() {
  ended = false;
  for (const int signal : {SIGINT, SIGTERM}) std::signal(signal, [](int) { ended = true; });
  return [] { return ended.load(); };
}

void warn_of(Drives& drives, const Variant& variant) {
  for (std::size_t i = 0; i < drives.size(); ++i) {
    const auto decoded = drives[i]->decoded(variant.settings[i]);
    const auto warn = [&](const std::string& line) {
      if (!line.empty()) std::cerr << "deltamap: warning: " << drives[i]->files().name << ": " << line << '\n';
    };
    for (const std::string& line : decoded->recorded.faults.lines()) warn(line);
    warn(daemon::doubt_of_pose(*drives[i]->map().grid, variant.settings[i]));
    if (drives.size() > 1) drives[i]->forget_decoded();  // decoded anew by its first run: all at once may be too much
  }
}

void warn_of_foreign_maps(const std::vector<WantedRun>& wanted, const std::vector<MeasuredRun>& runs,
                          const Drives& drives) {
  constexpr double kHardly = 0.6;  // of the beams: 0.85 and more agree in their own building, 0.5 at most in another
  for (std::size_t drive = 0; drive < drives.size(); ++drive) {
    double most = -1.0;
    for (std::size_t i = 0; i < wanted.size(); ++i) {
      if (wanted[i].drive == drive) most = std::max(most, number_of(runs[i].numbers, "agreement"));
    }
    if (most < 0.0 || most >= kHardly) continue;
    std::cerr << "deltamap: warning: " << drives[drive]->files().name << ": at most " << std::lround(100.0 * most)
              << " % of its beams agree with " << drives[drive]->files().map.string()
              << " in any run: is that the map of another site, or the start pose wrong?\n";
  }
}

}  // namespace deltamap::tool::tune
