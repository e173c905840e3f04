// SPDX-License-Identifier: Apache-2.0
#include "daemon/check_config.hpp"

#include <algorithm>
#include <filesystem>
#include <functional>
#include <optional>
#include <utility>

#include "core/counted.hpp"
#include "core/files/scratch_folder.hpp"
#include "daemon/dashboard/access.hpp"
#include "daemon/dashboard/server.hpp"
#include "daemon/first_map.hpp"
#include "daemon/kept/kept_drive.hpp"
#include "daemon/maps/newest_map.hpp"
#include "daemon/maps/store_opening.hpp"
#include "daemon/outputs/output_place.hpp"
#include "daemon/outputs/state_folders.hpp"
#include "daemon/records/live_recording.hpp"
#include "daemon/settings/provenance.hpp"
#include "daemon/settings/start_error.hpp"
#include "daemon/site/bays_file.hpp"
#include "daemon/site/zones_file.hpp"
#include "daemon/site_reload.hpp"
#include "daemon/sockets/listening_socket.hpp"
#include "daemon/start_banner.hpp"
#include "daemon/steps/localization_step.hpp"
#include "drivers/port/port_check.hpp"
#include "drivers/port/port_finder.hpp"
#include "drivers/port/port_permission.hpp"
#include "mapping/store/database_log.hpp"
#include "mapping/store/map_store.hpp"
#include "mapping/store/store_error.hpp"

namespace deltamap::daemon {
namespace {

namespace fs = std::filesystem;
using Level = Finding::Level;
using drivers::port::PortId;

// Paths and device drivers as systemd/deltamap.service sets them: the folder of settings, the two folders that the
// service may write to, folders that are hidden from it, folders that it has a private copy of, and the serial drivers
// whose devices it may open.
constexpr const char* kServiceSettings = "/etc/deltamap";
constexpr const char* kStateFolder = "/var/lib/deltamap";
constexpr const char* kRuntimeFolder = "/run/deltamap";
constexpr const char* kHidden[] = {"/home", "/root", "/run/user"};
constexpr const char* kOwnPlaces[] = {"/tmp", "/var/tmp"};
constexpr const char* kDrivers[] = {"ttyUSB", "ttyS", "ttyACM"};

bool is_below(const fs::path& file, const fs::path& folder) {
  const fs::path within = fs::absolute(file).lexically_normal().lexically_relative(folder);
  return !within.empty() && *within.begin() != "..";
}

Finding settings_finding(const Settings& settings, const std::string& config) {
  return {Level::kOk, "settings",
          config + ": " + std::to_string(changed_settings(settings).size()) + " not as delivered, fingerprint " +
              hex_of(settings_fingerprint(settings))};
}

std::string cells_text(const OccupancyGrid& grid) {
  const auto count = [&](CellState state) { return std::to_string(count_of(grid, state)); };
  return count(CellState::kFree) + " free, " + count(CellState::kOccupied) + " occupied, " +
         count(CellState::kUnknown) + " unknown";
}

/// Adds the finding about the map file; returns the map where it can be read.
std::optional<OccupancyGrid> check_map(const Settings& settings, const std::string& config,
                                       std::vector<Finding>& findings) {
  try {
    require_map_named(settings, config);
    FirstMap map = read_first_map(settings.map.file, memory_limit());
    require_pose_on(map.grid.geometry(), settings);
    findings.push_back(
        {Level::kOk, "map", settings.map.file + ": " + size_text(map.grid.geometry()) + ": " + cells_text(map.grid)});
    for (std::string& warning : map.warnings) findings.push_back({Level::kWarning, "map", std::move(warning)});
    if (std::string doubt = doubt_of_pose(map.grid, settings); !doubt.empty())
      findings.push_back({Level::kWarning, "map", std::move(doubt)});
    findings.push_back({Level::kOk, "memory", memory_text(settings.map.file, memory_limit())});
    const auto unit = unit_memory();
    if (std::string why = unit ? why_not_as_service(settings.map.file, *unit) : ""; !why.empty())
      findings.push_back({Level::kWarning, "memory", std::move(why)});
    return std::move(map.grid);
  } catch (const std::exception& error) {
    findings.push_back({Level::kError, "map", error.what()});
    return std::nullopt;
  }
}

/// Copies the database with its write-ahead log: a daemon that was killed may have left its newest revisions there.
void copy_store(const fs::path& store, const fs::path& target) {
  fs::copy_file(store, target);
  fs::permissions(target, fs::perms::owner_write, fs::perm_options::add);
  const fs::path log = mapping::store::log_of(store).log;
  if (fs::exists(log)) fs::copy_file(log, mapping::store::log_of(target).log);
}

/// Opens a copy of the store: a start repairs a damaged store and begins histories, and a check must change nothing.
Finding store_content(const std::string& store, const OccupancyGrid& first) {
  const ScratchFolder scratch;
  const fs::path copied = scratch.path() / "store.sqlite";
  const auto of_the_store = [&](std::string why) {
    if (const auto at = why.find(copied.string()); at != std::string::npos)
      why.replace(at, copied.string().size(), store);
    return why;
  };
  const std::uint32_t known = known_revision(store, first);
  if (was_emptied(store, known)) {
    const std::string lost = known > 0 ? "; " + words_of_missing(0, known) : "";
    return {Level::kWarning, "store",
            store + ": is empty: a start would set it aside and begin with the first map" + lost};
  }
  try {
    copy_store(store, copied);
    const mapping::store::MapStore copy{copied, first};
    std::size_t refusals = 0;
    for (const mapping::store::StoredRevision& one : copy.history()) refusals += one.refused ? 1 : 0;
    std::string text =
        store + ": newest revision of this map " + std::to_string(copy.newest()) + ", " + counted(refusals, "refusal");
    if (const std::string others = words_of_others(copy); !others.empty())
      return {Level::kWarning, "store", store + ": " + others};
    if (const std::string missing = words_of_missing(copy.newest(), known); !missing.empty())
      return {Level::kWarning, "store", store + ": " + missing};
    return {Level::kOk, "store", text};
  } catch (const mapping::store::StoreError& error) {
    const bool is_unsound = error.kind == mapping::store::StoreError::Kind::kUnsound;
    const char* what_then = is_unsound ? ": a start would set it aside and go on with what can be recovered of it"
                                       : ": a start would go on without it";
    return {Level::kWarning, "store", of_the_store(error.what()) + what_then};
  } catch (const std::exception& error) {
    return {Level::kWarning, "store", store + ": not opened: " + of_the_store(error.what())};
  }
}

/// Judges the place of an output whose folder may still be missing: a start makes the folder where this user may.
std::string judged_place(const fs::path& file, const std::function<std::string()>& judged) {
  std::error_code ignored;
  if (fs::is_directory(fs::absolute(file).parent_path(), ignored)) return judged();
  const std::string why = why_no_folder_for(file);
  if (!why.empty()) throw StartError(file.string() + ": " + why);
  return "";
}

/// Without a first map (its file could not be read) only the place of the store is judged.
Finding store_finding(const Settings& settings, const std::string& config, const std::optional<OccupancyGrid>& first) {
  const std::string& store = settings.map.store;
  std::error_code ignored;
  if (store.empty()) return {Level::kOk, "store", "none: the map is not kept across restarts"};
  try {
    require_store_folder(settings, config);
    const std::string why = judged_place(store, [&] { return judged_store_place(store); });
    if (!fs::exists(store, ignored)) {
      const std::string missing = first ? words_of_missing(0, known_revision(store, *first)) : "";
      if (missing.empty()) return {Level::kOk, "store", store + ": will be made"};
      return {Level::kWarning, "store", store + ": will be made: " + missing};
    }
    if (!first) return {Level::kWarning, "store", store + ": not opened, for it is another for each map"};
    Finding content = store_content(store, *first);
    if (why.empty()) return content;
    return {Level::kWarning, "store", why + ": a start would go on with its newest map; " + content.text};
  } catch (const std::exception& error) {
    return {Level::kError, "store", error.what()};
  }
}

Finding port_finding(const Settings& settings, PortId device) {
  using State = drivers::port::PortCheck::State;
  const std::string about{name_of(device)};
  const bool is_robot = device == drivers::port::PortId::kRobot;
  const drivers::port::PortCheck port = drivers::port::check_port(is_robot ? settings.robot.port : settings.laser.port);
  if (port.state == State::kReady) return {Level::kOk, about, port.text};
  if (port.state != State::kMissing) return {Level::kError, about, port.text};
  const drivers::port::PortFinder finder{settings.robot.port, settings.laser.port};
  return {Level::kWarning, about, port.text + finder.others_here(device)};
}

/// Whether a start would drive depends on the drive switch, which the last run has kept on disk.
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

/// Judges an output that a run writes: one file, or a whole folder, of which `file` then stands for all.
Finding place_finding(const std::string& about, const std::string& name, const fs::path& file,
                      const std::function<std::string()>& judged) {
  try {
    const std::string why = judged_place(file, judged);
    if (why.empty()) return {Level::kOk, about, name};
    return {Level::kWarning, about, why + ": a start would go on without it, and try again"};
  } catch (const std::exception& error) {
    return {Level::kError, about, error.what()};
  }
}

/// The name of the newest map is judged even where its folder is still missing.
Finding newest_finding(const MapSettings& map) {
  try {
    require_newest_named(map);
  } catch (const StartError& error) {
    return {Level::kError, "newest", error.what()};
  }
  return place_finding("newest", map.newest, map.newest, [&] { return judged_newest_place(map); });
}

/// A daemon that cannot be commanded still does its work, but two daemons do not share a socket, nor ports. The unit
/// makes its folder below /run at each start (RuntimeDirectory), which nobody but root could.
Finding socket_finding(const std::string& about, const fs::path& socket) {
  std::error_code ignored;
  if (socket.parent_path() == kRuntimeFolder && !fs::exists(kRuntimeFolder, ignored))
    return {Level::kOk, about, socket.string() + ": as a service; the unit makes " + kRuntimeFolder};
  if (const std::string why = why_no_folder_for(socket); !why.empty())
    return {Level::kWarning, about, socket.string() + ": " + why};
  try {
    sockets::require_way_clear(socket);
    return {Level::kOk, about, socket.string()};
  } catch (const sockets::AlreadyServed& error) {
    return {Level::kError, about, error.what()};
  } catch (const std::runtime_error& error) {
    return {Level::kWarning, about, error.what()};
  }
}

/// A daemon that keeps no incidents still does its work, but two daemons do not share a folder.
Finding incidents_finding(const fs::path& folder) {
  try {
    if (const std::string why = why_no_folder_for(folder / "any"); !why.empty())
      return {Level::kWarning, "incidents",
              folder.string() + ": " + why + ": a start would go on without it, and try again"};
    std::error_code error;
    if (fs::is_directory(folder, error)) require_lockable_folder(folder);
    return {Level::kOk, "incidents", folder.string()};
  } catch (const FileInUse& error) {
    return {Level::kError, "incidents", error.what()};
  } catch (const std::system_error& error) {
    return {Level::kWarning, "incidents", error.what()};
  }
}

Finding bays_finding(const Settings& settings, const GridGeometry& map) {
  try {
    const std::size_t count = bays_on(map, settings.bays.file).size();
    return {Level::kOk, "bays", settings.bays.file + ": " + counted(count, "bay")};
  } catch (const std::runtime_error& error) {
    return {Level::kError, "bays", error.what()};
  }
}

Finding zones_finding(const Settings& settings, const GridGeometry& map) {
  try {
    const Zones zones = zones_on(map, settings.zones.file);
    const auto over = settings.initial_pose
                          ? zones_over(settings.initial_pose->position(), zones, settings.navigation.safety)
                          : std::vector<std::string>{};
    std::string lines;
    for (const std::string& line : over) {
      if (!lines.empty()) lines += "; ";
      lines += line;
    }
    if (!lines.empty()) return {Level::kWarning, "zones", settings.zones.file + ": " + lines};
    return {Level::kOk, "zones", settings.zones.file + ": " + counted(zones.size(), "zone")};
  } catch (const std::runtime_error& error) {
    return {Level::kError, "zones", error.what()};
  }
}

/// Opens the page's port for a moment, as a start would, and closes it again.
Finding page_finding(const DashboardSettings& page) {
  try {
    const dashboard::Server server{{.address = page.address,
                                    .port = page.port,
                                    .guard = {.token = dashboard::token_in(page.token_file)},
                                    .answer = {},
                                    .open = {}}};
    return {Level::kOk, "page", "http://" + server.place() + "/"};
  } catch (const std::exception& error) {
    return {Level::kWarning, "page", std::string(error.what()) + ": a start would go on without it"};
  }
}

}  // namespace

std::vector<Finding> what_the_service_may_not(const Settings& settings) {
  std::vector<Finding> findings;
  const auto add = [&](const char* key, const std::string& file, const char* why) {
    findings.push_back(
        {Level::kWarning, "service", std::string("'") + key + "' " + file + ": deltamap.service " + why});
  };
  const auto require_seen = [&](const char* key, const std::string& file) {
    const auto lies_in = [&](const char* folder) { return is_below(file, folder); };
    if (file.empty()) return;
    if (std::any_of(std::begin(kHidden), std::end(kHidden), lies_in))
      add(key, file, "does not see what lies in /home, /root and /run/user");
    if (std::any_of(std::begin(kOwnPlaces), std::end(kOwnPlaces), lies_in))
      add(key, file, "has a /tmp and a /var/tmp of its own");
  };
  require_seen("map.file", settings.map.file);
  require_seen("dashboard.token_file", settings.dashboard.token_file);
  require_seen("bays.file", settings.bays.file);
  require_seen("zones.file", settings.zones.file);
  const auto require_allowed = [&](const char* key, const std::string& port) {
    const std::string driver = drivers::port::driver_of(port);
    const auto is_allowed = [&](const char* allowed) { return driver == allowed; };
    if (driver.empty() || std::any_of(std::begin(kDrivers), std::end(kDrivers), is_allowed)) return;
    findings.push_back(
        {Level::kWarning, "service",
         std::string("'") + key + "' " + port + ": deltamap.service needs " + drivers::port::way_past_the_unit(port)});
  };
  require_allowed("robot.port", settings.robot.port);
  require_allowed("laser.port", settings.laser.port);
  const auto require_written = [&](const char* key, const std::string& file) {
    if (file.empty() || is_below(file, kStateFolder) || is_below(file, kRuntimeFolder)) return;
    add(key, file, "may write to /var/lib/deltamap and /run/deltamap alone");
  };
  require_written("map.store", settings.map.store);
  require_written("map.newest", settings.map.newest);
  require_written("recording.file", settings.recording.file);
  require_written("control.socket", settings.control.socket);
  require_written("poses.socket", settings.poses.socket);
  return findings;
}

std::vector<Finding> check_config(const Settings& settings, const std::string& config, const std::string& out) {
  std::vector<Finding> findings{settings_finding(settings, config)};
  const auto first = check_map(settings, config, findings);
  findings.push_back(store_finding(settings, config, first));
  if (!settings.map.newest.empty()) findings.push_back(newest_finding(settings.map));
  findings.push_back(port_finding(settings, PortId::kRobot));
  findings.push_back(port_finding(settings, PortId::kLaser));
  findings.push_back(drive_finding(settings));
  if (!settings.control.socket.empty()) findings.push_back(socket_finding("control", settings.control.socket));
  if (!settings.poses.socket.empty()) findings.push_back(socket_finding("poses", settings.poses.socket));
  if (settings.dashboard.port != 0) findings.push_back(page_finding(settings.dashboard));
  if (const std::string& file = settings.recording.file; !file.empty()) {
    findings.push_back(place_finding("recording", file, file, [&] { return judged_recording_place(file); }));
  }
  if (first && !settings.bays.file.empty()) findings.push_back(bays_finding(settings, first->geometry()));
  if (first && !settings.zones.file.empty()) findings.push_back(zones_finding(settings, first->geometry()));
  if (!settings.incidents.folder.empty()) findings.push_back(incidents_finding(settings.incidents.folder));
  if (!out.empty()) {
    findings.push_back(
        place_finding("out", out, fs::path(out) / "report.json", [&] { return judged_out_place(out, settings); }));
  }
  if (is_below(config, kServiceSettings)) {
    const std::vector<Finding> more = what_the_service_may_not(settings);
    findings.insert(findings.end(), more.begin(), more.end());
  }
  return findings;
}

std::vector<Finding> check_what_is_read(const SettingsReading& reading, const std::string& config) {
  const std::size_t mistakes = reading.problems.size();
  std::vector<Finding> findings{
      {Level::kError, "settings", config + ": " + counted(mistakes, "mistake") + ": see standard error"}};
  const Settings& settings = reading.settings;
  if (reading.knows("map.file") && !settings.map.file.empty()) (void)check_map(settings, config, findings);
  if (reading.knows("robot.port")) findings.push_back(port_finding(settings, PortId::kRobot));
  if (reading.knows("laser.port")) findings.push_back(port_finding(settings, PortId::kLaser));
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
