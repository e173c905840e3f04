// SPDX-License-Identifier: Apache-2.0
#include "daemon/check_config.hpp"

#include <algorithm>
#include <filesystem>
#include <optional>

#include "core/grid_file.hpp"
#include "daemon/control/client.hpp"
#include "daemon/kept_drive.hpp"
#include "daemon/localization_step.hpp"
#include "daemon/outputs.hpp"
#include "daemon/provenance.hpp"
#include "daemon/scratch_folder.hpp"
#include "daemon/start_banner.hpp"
#include "daemon/state_folders.hpp"
#include "drivers/port/port_check.hpp"
#include "mapping/map_store.hpp"
#include "mapping/store_error.hpp"

namespace deltamap::daemon {
namespace {

namespace fs = std::filesystem;
using Level = Finding::Level;

Finding settings_finding(const Settings& settings, const std::string& config) {
  return {Level::kOk, "settings",
          config + ": " + std::to_string(changed_settings(settings).size()) + " not as delivered, fingerprint " +
              fingerprint_text(settings)};
}

std::string cells_text(const OccupancyGrid& grid) {
  const auto count = [&](CellState state) {
    return std::to_string(std::count(grid.cells().begin(), grid.cells().end(), state));
  };
  return count(CellState::kFree) + " free, " + count(CellState::kOccupied) + " occupied, " +
         count(CellState::kUnknown) + " unknown";
}

/// The map itself, where it can be read.
std::optional<OccupancyGrid> check_map(const Settings& settings, const std::string& config,
                                       std::vector<Finding>& findings) {
  try {
    if (settings.map.file.empty()) throw std::runtime_error(config + ": 'map.file' names no map");
    OccupancyGrid grid = read_grid(settings.map.file);
    require_pose_on(grid.geometry(), settings);
    findings.push_back(
        {Level::kOk, "map", settings.map.file + ": " + size_text(grid.geometry()) + ": " + cells_text(grid)});
    return grid;
  } catch (const std::exception& error) {
    findings.push_back({Level::kError, "map", error.what()});
    return std::nullopt;
  }
}

/// With its write-ahead log: what a daemon that was killed has left there belongs to the store.
void copy_store(const fs::path& store, const fs::path& target) {
  if (fs::is_directory(store)) throw std::runtime_error(store.string() + ": is a directory");
  fs::copy_file(store, target);
  const fs::path log = store.string() + "-wal";
  if (fs::exists(log)) fs::copy_file(log, target.string() + "-wal");
}

/// Opened as a start opens it, which mends and begins histories: hence a copy.
Finding store_content(const std::string& store, const OccupancyGrid& first) {
  const ScratchFolder scratch;
  const fs::path copied = scratch.path() / "store.sqlite";
  const auto of_the_store = [&](std::string why) {
    if (const auto at = why.find(copied.string()); at != std::string::npos)
      why.replace(at, copied.string().size(), store);
    return why;
  };
  try {
    copy_store(store, copied);
    const mapping::MapStore copy{copied, first};
    std::size_t refusals = 0;
    for (const mapping::StoredRevision& one : copy.history()) refusals += one.refused ? 1 : 0;
    std::string text = store + ": newest revision of this map " + std::to_string(copy.newest()) + ", " +
                       std::to_string(refusals) + " refusals";
    if (copy.dropped() == 0) return {Level::kOk, "store", text};
    return {Level::kWarning, "store", text + ", " + std::to_string(copy.dropped()) + " damaged revisions are dropped"};
  } catch (const mapping::StoreError& error) {
    const bool is_unsound = error.kind == mapping::StoreError::Kind::kUnsound;
    const std::string why = of_the_store(error.what()) + (is_unsound ? ": a start would set it aside" : "");
    return {is_unsound ? Level::kWarning : Level::kError, "store", why};
  } catch (const std::exception& error) {
    return {Level::kError, "store", of_the_store(error.what())};
  }
}

/// `first` is nothing where the map could not be read.
Finding store_finding(const Settings& settings, const std::string& config, const std::optional<OccupancyGrid>& first) {
  const std::string& store = settings.map.store;
  std::error_code ignored;
  if (store.empty()) return {Level::kOk, "store", "none: the map is not kept across restarts"};
  if (const std::string why = why_no_folder_for(store); !why.empty()) {
    return {Level::kError, "store", store_refusal(settings, config, why)};
  }
  if (!fs::exists(store, ignored)) return {Level::kOk, "store", store + ": will be made"};
  if (!first) return {Level::kWarning, "store", store + ": not opened, for it is another for each map"};
  return store_content(store, *first);
}

Finding port_finding(const std::string& about, const std::string& path) {
  using State = drivers::port::PortCheck::State;
  const drivers::port::PortCheck port = drivers::port::check_port(path);
  if (port.state == State::kReady) return {Level::kOk, about, port.text};
  return {port.state == State::kMissing ? Level::kWarning : Level::kError, about, port.text};
}

/// Whether it would drive is a person's word, which a run before has kept.
Finding drive_finding(const Settings& settings) {
  const std::string mode(name_of(settings.navigation.mode));
  if (settings.navigation.mode == navigation::DriveMode::kOff)
    return {Level::kOk, "drive", mode + ": it never moves the robot"};
  const KeptDriveAnswer kept = read_kept_drive(drive_place(settings.map.store, settings.robot.port));
  if (!kept.why_unknown.empty()) return {Level::kWarning, "drive", mode + ": " + kept.why_unknown};
  const std::string told(drivers::pioneer::name_of(kept.value));
  const bool drives = kept.value == KeptDrive::DriveSwitch::kOn;
  return {Level::kOk, "drive", mode + ": the switch is " + told + (drives ? ": it would drive" : ": it would stand")};
}

/// A file that is written as the run goes; without it the daemon goes on.
void check_written(const std::string& about, const std::string& file, std::vector<Finding>& findings) {
  if (file.empty()) return;
  const std::string why = why_no_folder_for(file);
  findings.push_back({why.empty() ? Level::kOk : Level::kWarning, about, file + (why.empty() ? "" : ": " + why)});
}

/// Two daemons do not share a socket, nor ports.
void check_control(const std::string& socket, std::vector<Finding>& findings) {
  std::error_code ignored;
  if (!fs::is_socket(socket, ignored)) return check_written("control", socket, findings);
  try {
    (void)control::exchange(socket, R"({"command":"status"})");
    findings.push_back({Level::kError, "control", socket + ": another daemon listens there"});
  } catch (const std::exception&) {  // left by one that was killed: it is replaced
    check_written("control", socket, findings);
  }
}

void check_out(const Settings& settings, const std::string& out, std::vector<Finding>& findings) {
  if (out.empty()) return;
  try {
    if (const std::string why = why_no_folder_for(fs::path(out) / "report.json"); !why.empty())
      throw std::runtime_error(why);
    require_map_elsewhere(settings.map.file, out);
    findings.push_back({Level::kOk, "out", out});
  } catch (const std::exception& error) {
    findings.push_back({Level::kError, "out", error.what()});
  }
}

}  // namespace

std::vector<Finding> check_config(const Settings& settings, const std::string& config, const std::string& out) {
  std::vector<Finding> findings{settings_finding(settings, config)};
  const auto first = check_map(settings, config, findings);
  findings.push_back(store_finding(settings, config, first));
  findings.push_back(port_finding("robot", settings.robot.port));
  findings.push_back(port_finding("laser", settings.laser.port));
  findings.push_back(drive_finding(settings));
  check_control(settings.control.socket, findings);
  check_written("recording", settings.recording.file, findings);
  check_out(settings, out, findings);
  return findings;
}

bool has_error(const std::vector<Finding>& findings) {
  return std::any_of(findings.begin(), findings.end(), [](const Finding& one) { return one.level == Level::kError; });
}

std::string text_of(const std::vector<Finding>& findings) {
  std::string text;
  for (const Finding& one : findings) {
    std::string line = one.level == Level::kOk ? "ok" : one.level == Level::kWarning ? "warning" : "error";
    line.resize(9, ' ');
    line += one.about;
    line.resize(19, ' ');
    text += line + one.text + "\n";
  }
  return text + (has_error(findings) ? "it would not start, or not work: see each error\n" : "it would start\n");
}

}  // namespace deltamap::daemon
