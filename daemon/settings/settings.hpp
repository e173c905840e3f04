// SPDX-License-Identifier: Apache-2.0
// What the operator may choose. Read strictly from one YAML file and --set overrides: an unknown key, a value of the
// wrong type or outside its range stops the start, with a line for each mistake. Behind this door everything is in
// metres, radians and seconds.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "core/geometry/pose2.hpp"
#include "daemon/settings/reader/setting_key.hpp"
#include "daemon/settings/settings_error.hpp"
#include "drivers/lms200/session.hpp"
#include "drivers/pioneer/session.hpp"
#include "localization/localizer_params.hpp"
#include "mapping/map_update_params.hpp"
#include "mapping/paper/divergence_ratio.hpp"
#include "mapping/store/retention.hpp"
#include "mapping/store_scan.hpp"
#include "mapping/things/body.hpp"
#include "navigation/drive_mode.hpp"
#include "navigation/safety.hpp"
#include "navigation/wander.hpp"

namespace deltamap::daemon {

struct RobotSettings {
  std::string port = "/dev/ttyUSB0";
  double distance_unit_mm = 0.0;  ///< as written; session.by_hand has it in metres. 0: by the robot's subtype
  /// enable_motors is not a key: it follows from navigation.mode. by_hand.hull_m: navigation.safety.robot_radius_m,
  /// where that key was given.
  drivers::pioneer::PioneerParams session;
};

struct LaserSettings {
  std::string port = "/dev/ttyUSB1";
  drivers::lms200::Lms200Params session;
};

struct MapSettings {
  std::string file;                     ///< M_0
  std::string store;                    ///< revisions; empty: not kept
  mapping::store::Retention retention;  ///< of the store
  std::string newest;                   ///< YAML of the newest revision, for other programs; empty: none
};

struct MappingSettings {
  bool enabled = true;
  mapping::paper::DivergenceRatioParams divergence;  ///< w_fast, w_slow, r_d: mapping paused or not
  mapping::StoreScanParams store_scan;
  mapping::MapUpdateParams update;
  mapping::things::ThingsParams things;
};

struct NavigationSettings {
  navigation::DriveMode mode = navigation::DriveMode::kOff;
  bool drive_without_pose = false;  ///< while the localizer searches, is lost or calls its pose wrong
  navigation::SafetyParams safety;
  navigation::WanderParams wander;
};

struct RecordingSettings {
  std::string file;            ///< pcapng; empty: not recorded
  double max_gigabytes = 8.0;  ///< the recording ends there, the daemon goes on; a ring does not
  // A ring of parts, of which the oldest go. 0: no such rule; both 0: one file, no ring.
  double keep_gigabytes = 0.0;
  double keep_hours = 0.0;

  [[nodiscard]] bool is_ring() const { return !file.empty() && (keep_gigabytes > 0.0 || keep_hours > 0.0); }
};

/// The minutes around each loss, fault, safety stop and operator's mark.
struct IncidentSettings {
  std::string folder;             ///< empty: nothing is kept
  std::uint32_t max_count = 100;  ///< the oldest that is not pinned goes
  double max_gigabytes = 2.0;     ///< of all of them
};

/// The places on the floor that goods are put on.
struct BaysSettings {
  std::string file;  ///< bays.yaml; empty: none are judged
};

/// Areas in which other rules hold.
struct ZonesSettings {
  std::string file;  ///< zones.yaml; empty: none
};

/// What outlives the run, beside map.store; a replay does not look at it.
struct MemorySettings {
  double pose_period_s = 5.0;  ///< between two writings of the pose; > 0
};

struct ControlSettings {
  std::string socket;  ///< for `deltamap ctl`; empty: none
};

/// Pose and verdict of every scan, for programs on this machine.
struct PosesSettings {
  std::string socket;  ///< empty: none
};

/// The live page, for browsers.
struct DashboardSettings {
  std::string address = "127.0.0.1";  ///< beyond loopback only with a token
  std::uint16_t port = 0;             ///< 0: no page
  std::string token_file;             ///< its first line is asked of every viewer; empty: nothing is asked
  bool control = false;               ///< the page may command, not only show; what moves the robot needs a token
};

struct Settings {
  std::uint64_t seed = 1;
  RobotSettings robot;
  LaserSettings laser;
  MapSettings map;
  std::optional<Pose2> initial_pose;  ///< map_from_robot at the first scan; nothing: global localization
  localization::LocalizerParams localizer;
  MemorySettings memory;
  MappingSettings mapping;
  NavigationSettings navigation;
  ControlSettings control;
  PosesSettings poses;
  DashboardSettings dashboard;
  RecordingSettings recording;
  IncidentSettings incidents;
  BaysSettings bays;
  ZonesSettings zones;
};

/// A recording of this run may begin in its midst: the localizer is asked now and then what it knows.
[[nodiscard]] inline bool has_checkpoints(const Settings& settings) {
  return !settings.incidents.folder.empty() || settings.recording.is_ring();
}

/// Every key, in the order of config/default.yaml. The keys refer to `settings`, which must outlive them.
[[nodiscard]] std::vector<SettingKey> keys_of(Settings& settings);

/// Values that are each in range and cannot be together.
struct Contradiction {
  std::string key;                  ///< the one that is told
  std::string what;                 ///< the rule that is broken: "must not exceed 'laser.max_range_m'"
  std::vector<std::string> others;  ///< the other keys that the rule concerns
};
[[nodiscard]] std::vector<Contradiction> contradictions_in(const Settings& settings);

/// `overrides` are "key=value" as given to --set, in order, after the file. Throws SettingsError with all
/// mistakes of both.
[[nodiscard]] Settings read_settings(const std::filesystem::path& file, const std::vector<std::string>& overrides);
/// The same where a file need not be given: as delivered where it is empty.
[[nodiscard]] Settings settings_or_defaults(const std::string& file, const std::vector<std::string>& overrides);
/// The same from text; `name` stands for the file in errors.
[[nodiscard]] Settings parse_settings(const std::string& yaml, const std::string& name,
                                      const std::vector<std::string>& overrides = {});

/// Key and value, as YAML, of everything that is not as delivered, in the order of config/default.yaml.
[[nodiscard]] std::vector<std::pair<std::string, std::string>> changed_settings(const Settings& settings);

/// Names everything that decides what comes out of the same bytes: ports, files and recording are left out.
[[nodiscard]] std::uint64_t settings_fingerprint(const Settings& settings);

}  // namespace deltamap::daemon
