// SPDX-License-Identifier: Apache-2.0
// `deltamap incident`: what the daemon has kept of bad moments, listed, told, replayed, looked at and packed.
#include <CLI/CLI.hpp>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <memory>
#include <nlohmann/json.hpp>
#include <set>
#include <stdexcept>
#include <string>
#include <vector>

#include "core/counted.hpp"
#include "core/files/scratch_folder.hpp"
#include "core/utc_text.hpp"
#include "daemon/incidents/incident_list.hpp"
#include "daemon/replay/incident_replay.hpp"
#include "daemon/settings/reader/nearest_key.hpp"
#include "tool/draft.hpp"
#include "tool/incident/tar_file.hpp"
#include "tool/progress.hpp"
#include "tool/subcommands.hpp"
#include "tool/view/view.hpp"

namespace deltamap::tool {
namespace {

namespace fs = std::filesystem;

constexpr const char* kDeliveredFolder = "/var/lib/deltamap/incidents";

struct IncidentOptions {
  fs::path folder = kDeliveredFolder;
  fs::path incident;
  std::vector<fs::path> incidents;
  fs::path out;
  std::uint16_t port = 0;
  bool as_json = false;
};

[[noreturn]] void refuse_name(const IncidentOptions& options, const fs::path& named) {
  std::vector<std::string> names;
  for (const daemon::StoredIncident& stored : daemon::incidents_in(options.folder)) {
    names.push_back(stored.incident.name);
  }
  const auto nearest = daemon::nearest_of(names, named.string());
  const std::string hint = nearest         ? "nearest name " + *nearest
                           : names.empty() ? "it holds no incident"
                                           : "`deltamap incident list` names its " + counted(names.size(), "incident");
  throw std::runtime_error(options.folder.string() + ": holds no incident " + named.string() + " (" + hint + ")");
}

/// A folder, or the name of one of those in --folder.
fs::path folder_of(const IncidentOptions& options, const fs::path& named) {
  std::error_code error;
  fs::path plain = named.has_filename() ? named : named.parent_path();  // "NAME/", as shells complete it
  if (fs::exists(plain, error)) return plain;
  if (fs::exists(options.folder / plain, error)) return options.folder / plain;
  refuse_name(options, plain);
}

void list(const IncidentOptions& options) {
  std::error_code error;
  if (!fs::is_directory(options.folder, error))
    throw std::runtime_error(options.folder.string() +
                             ": is no folder: `deltamap incident list FOLDER` with the daemon's 'incidents.folder'");
  const std::vector<daemon::StoredIncident> all = daemon::incidents_in(options.folder);
  if (options.as_json) {
    std::cout << daemon::json_of(all) << '\n';
    return;
  }
  for (const daemon::StoredIncident& stored : all) std::cout << line_of(stored) << '\n';
  if (all.empty()) std::cout << options.folder.string() << ": no incident\n";
}

void show(const IncidentOptions& options) {
  const fs::path folder = folder_of(options, options.incident);
  const daemon::Incident incident = daemon::read_incident(folder);
  std::cout << (options.as_json ? json_text(incident)
                                : words_of(incident, fs::is_regular_file(folder / daemon::kIncidentPicture)));
}

/// "the live run: lost at …; the replay: the same 0.1 s later"
std::string words_of_replay(const daemon::Incident& incident, const daemon::IncidentReplay& replay) {
  const std::string met = "the replay lost its pose " + counted(replay.losses.size(), "time") + ", ";
  const daemon::IncidentEvent* live = loss_of(incident);
  if (live == nullptr) {
    return (replay.losses.empty() ? "neither the live run nor the replay lost its pose" : met + "the live run never") +
           " (kept for: " + std::string(name_of(incident.events.front().kind)) + ")";
  }
  const std::string began = "the live run: " + std::string(name_of(live->kind)) + " at " + utc_text(live->time) + "; ";
  if (!replay.late_s) return began + met + "never of this kind";
  char text[96];
  (void)std::snprintf(text, sizeof text, "the replay: the same %.1f s %s", std::abs(*replay.late_s),
                      *replay.late_s < 0.0 ? "earlier" : "later");
  return began + text;
}

void replay(const IncidentOptions& options) {
  const fs::path folder = folder_of(options, options.incident);
  const daemon::Incident incident = daemon::read_incident(folder);
  const ScratchFolder scratch;
  daemon::ReplayJob job = daemon::incident_job(folder);
  job.out = options.out.empty() ? scratch.path() / "run" : options.out;
  job.warn = [](const std::string& line) { std::cerr << "deltamap: warning: " << line << '\n'; };
  daemon::IncidentReplay done;
  {
    constexpr std::uint64_t kSteps = 1000;
    Progress progress{"replay", kSteps};
    done = daemon::replayed_incident(incident, job, [&](double share) {
      progress.show(static_cast<std::uint64_t>(share * static_cast<double>(kSteps)));
      return true;
    });
  }
  if (!options.as_json) {
    std::cout << words_of_replay(incident, done) << '\n';
    return;
  }
  nlohmann::ordered_json json{{"name", incident.name}, {"losses", done.losses.size()}, {"began", done.report.began}};
  json["late_s"] = done.late_s ? nlohmann::ordered_json(*done.late_s) : nlohmann::ordered_json(nullptr);
  std::cout << json.dump() << '\n';
}

void pack(const IncidentOptions& options) {
  std::vector<fs::path> folders;
  std::set<fs::path> names;  // within the file
  for (const fs::path& named : options.incidents) {
    const fs::path folder = fs::weakly_canonical(folder_of(options, named));
    (void)daemon::read_incident(folder);
    if (!names.insert(folder.filename()).second) {
      throw std::runtime_error(folder.string() + ": " + folder.filename().string() +
                               " is named twice: in one file its parts would lie over each other");
    }
    folders.push_back(folder);
  }
  const fs::path file = !options.out.empty() ? options.out : fs::path(folders.front().filename().string() + ".tar");
  Draft draft{file};
  TarWriter tar{draft.path()};
  for (const fs::path& folder : folders) tar.add_folder(folder);
  tar.finish();
  draft.keep();
  std::cout << file.string() << ": " << counted(folders.size(), "incident") << '\n';
}

void pin(const IncidentOptions& options, bool is_pinned) {
  for (const fs::path& named : options.incidents) {
    const fs::path folder = folder_of(options, named);
    (void)daemon::read_incident(folder);
    const fs::path pin = folder / daemon::kIncidentPin;
    std::error_code error;
    if (!is_pinned) fs::remove(pin, error);
    if (error || (is_pinned && !std::ofstream(pin))) throw std::runtime_error(pin.string() + ": cannot be changed");
  }
}

void add_to_many(CLI::App& command, const std::shared_ptr<IncidentOptions>& options) {
  command.add_option("INCIDENT", options->incidents, "their folders, or names in --folder")->required();
}

void add_to_one(CLI::App& command, const std::shared_ptr<IncidentOptions>& options) {
  command.add_option("INCIDENT", options->incident, "its folder, or its name in --folder")->required();
}

}  // namespace

void add_incident(CLI::App& app) {
  auto options = std::make_shared<IncidentOptions>();
  CLI::App& incident =
      *app.add_subcommand("incident", "the bad moments that the daemon has kept")->require_subcommand(1)->fallthrough();
  incident.add_option("--folder", options->folder, "incidents.folder of the daemon (/var/lib/deltamap/incidents)");
  incident.add_flag("--json", options->as_json, "of list, show and replay: JSON");
  CLI::App& listing = *incident.add_subcommand("list", "all of a folder, oldest first");
  listing.add_option("FOLDER", options->folder, "in place of --folder");
  listing.callback([options] { list(*options); });
  CLI::App& showing = *incident.add_subcommand("show", "what happened, when, where, and what to do");
  add_to_one(showing, options);
  showing.callback([options] { show(*options); });
  CLI::App& opening = *incident.add_subcommand("open", "replay it in the page, as deltamap view does");
  add_to_one(opening, options);
  opening.add_option("--port", options->port, "of the page, on loopback; 0 (as delivered): any that is free");
  opening.callback([options] { view_incident(folder_of(*options, options->incident), options->port); });
  CLI::App& replaying = *incident.add_subcommand("replay", "whether a replay meets the same");
  add_to_one(replaying, options);
  replaying.add_option("--out", options->out, "folder for the files of the replay");
  replaying.callback([options] { replay(*options); });
  CLI::App& packing = *incident.add_subcommand("pack", "one tar file of it, to send");
  add_to_many(packing, options);
  packing.add_option("--out", options->out, "file to write (the first one's name and .tar)");
  packing.callback([options] { pack(*options); });
  CLI::App& pinning = *incident.add_subcommand("pin", "never removed by the daemon's limits");
  add_to_many(pinning, options);
  pinning.callback([options] { pin(*options, true); });
  CLI::App& unpinning = *incident.add_subcommand("unpin", "removed again where the limits ask for it");
  add_to_many(unpinning, options);
  unpinning.callback([options] { pin(*options, false); });
}

}  // namespace deltamap::tool
