// SPDX-License-Identifier: Apache-2.0
#include "daemon/settings/run_contradictions.hpp"

#include <filesystem>
#include <stdexcept>
#include <system_error>
#include <utility>

#include "core/files/file_lock.hpp"
#include "core/files/grid_file.hpp"
#include "daemon/settings/memory_places.hpp"
#include "mapping/store/database_log.hpp"
#include "navigation/fan.hpp"

namespace deltamap::daemon {
namespace {

namespace fs = std::filesystem;

struct NamedFile {
  std::string key;   ///< empty: the settings file, which no key names
  std::string part;  ///< what is named after the key's file: "image"; empty: that file itself
  fs::path file;
  bool is_written = true;

  [[nodiscard]] std::string name() const {
    if (key.empty()) return "this settings file";
    return (part.empty() ? "" : "the " + part + " of ") + "'" + key + "'";
  }
};

/// The file behind a link; the absolute name where it cannot be looked at.
fs::path behind(const fs::path& file) {
  try {
    return file_behind(file);
  } catch (const std::system_error&) {
    return fs::absolute(file).lexically_normal();
  }
}

bool is_same(const fs::path& one, const fs::path& other) {
  std::error_code not_both_are_there;
  return fs::equivalent(one, other, not_both_are_there) || behind(one) == behind(other);
}

/// All files that the settings name. Those that are only read come first, so that of two keys with one file the output
/// is the one that is reported.
std::vector<NamedFile> files_of(const Settings& settings, const std::string& file) {
  std::vector<NamedFile> files{{"", "", file, false}};
  const auto add = [&](const std::string& key, const std::string& named, bool is_written) {
    if (!named.empty()) files.push_back({key, "", named, is_written});
  };
  const auto add_map = [&](const std::string& key, const std::string& yaml, bool is_written) {
    add(key, yaml, is_written);
    if (yaml.empty()) return;
    files.push_back(
        {key, "image", is_written ? fs::path(yaml).replace_extension(".pgm") : picture_named_in(yaml), is_written});
  };
  add_map("map.file", settings.map.file, false);
  add("dashboard.token_file", settings.dashboard.token_file, false);
  add("bays.file", settings.bays.file, false);
  add("zones.file", settings.zones.file, false);
  add("map.store", settings.map.store, true);
  if (const std::string& store = settings.map.store; !store.empty()) {
    const MemoryPlaces kept = memory_places(store);
    const auto add_kept = [&](const char* part, const fs::path& place) {
      files.push_back({"map.store", part, place, true});
    };
    const auto [log, index] = mapping::store::log_of(store);
    add_kept("log", log);
    add_kept("log's index", index);
    add_kept("kept pose", kept.pose);
    add_kept("kept stability", kept.stability);
    add_kept("kept things", kept.things);
    add_kept("kept bays", kept.bays);
    add_kept("saved map", kept.saved_map);
    add_kept("saved map's image", fs::path(kept.saved_map).replace_extension(".pgm"));
  }
  add_map("map.newest", settings.map.newest, true);
  add("control.socket", settings.control.socket, true);
  add("poses.socket", settings.poses.socket, true);
  add("recording.file", settings.recording.file, true);
  if (const std::string& recording = settings.recording.file; !recording.empty())
    files.push_back({"recording.file", "recording of the run before", previous_recording(recording), true});
  add("incidents.folder", settings.incidents.folder, true);
  return files;
}

void add_file_contradictions(const Settings& settings, const std::string& file, std::vector<Contradiction>& found) {
  const std::vector<NamedFile> files = files_of(settings, file);
  for (std::size_t late = 0; late < files.size(); ++late) {
    for (std::size_t early = 0; early < late && files[late].is_written; ++early) {
      const NamedFile& one = files[late];
      const NamedFile& other = files[early];
      const bool is_told = !found.empty() && found.back().key == one.key;
      if (is_told || one.key == other.key || !is_same(one.file, other.file)) continue;
      const std::string subject = one.part.empty() ? "" : "its " + one.part + " ";
      std::vector<std::string> others;
      if (!other.key.empty()) others.push_back(other.key);
      found.push_back({one.key, subject + "must not be the same file as " + other.name(), std::move(others)});
    }
  }
}

void add_port_contradictions(const Settings& settings, std::vector<Contradiction>& found) {
  const std::string& robot = settings.robot.port;
  const std::string& laser = settings.laser.port;
  if (robot.empty()) found.push_back({"robot.port", "must name a serial device", {}});
  if (laser.empty()) found.push_back({"laser.port", "must name a serial device", {}});
  if (!robot.empty() && !laser.empty() && is_same(robot, laser))
    found.push_back({"laser.port", "must not be the same device as 'robot.port'", {"robot.port"}});
}

/// Only a shell knows what `~` stands for: a file named so would lie in a folder "~" of the working directory.
void add_home_contradictions(const Settings& settings, const std::string& file, std::vector<Contradiction>& found) {
  std::vector<NamedFile> named = files_of(settings, file);
  named.push_back({"robot.port", "", settings.robot.port});
  named.push_back({"laser.port", "", settings.laser.port});
  for (const NamedFile& one : named) {
    if (!one.key.empty() && one.part.empty() && one.file.string().starts_with("~"))
      found.push_back({one.key, "'~' is not expanded: write the whole path", {}});
  }
}

/// A wandering robot drives forward: a laser that looks aside or back would not see what lies ahead.
void add_mount_contradictions(const Settings& settings, std::vector<Contradiction>& found) {
  if (settings.navigation.mode == navigation::DriveMode::kOff) return;
  const drivers::lms200::Lms200Params& laser = settings.laser.session;
  const double field_rad = radians(laser.variant.angle_deg);
  const navigation::Fan fan{laser.robot_from_laser, -0.5 * field_rad, field_rad};
  const navigation::SafetyParams& safety = settings.navigation.safety;
  if (navigation::covers_way_ahead(fan, safety.robot_radius_m + safety.margin_m)) return;
  found.push_back({"laser.mount.yaw_deg",
                   "with 'navigation.mode' " + std::string(name_of(settings.navigation.mode)) +
                       " the laser must look where the robot drives, as wide as its hull and margin: see "
                       "'laser.mount', 'laser.variant' and 'navigation.safety'",
                   {"laser.mount.x_m", "laser.mount.y_m", "laser.variant", "navigation.mode",
                    "navigation.safety.robot_radius_m", "navigation.safety.margin_m"}});
}

}  // namespace

std::vector<Contradiction> contradictions_in_a_run(const Settings& settings, const std::string& file) {
  std::vector<Contradiction> found;
  add_port_contradictions(settings, found);
  add_file_contradictions(settings, file, found);
  add_home_contradictions(settings, file, found);
  add_mount_contradictions(settings, found);
  return found;
}

}  // namespace deltamap::daemon
