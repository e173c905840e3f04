// SPDX-License-Identifier: Apache-2.0
// The table of keys: what config/default.yaml lists, in its order.
#include <algorithm>
#include <functional>
#include <limits>
#include <optional>
#include <utility>

#include "daemon/dashboard/access.hpp"
#include "daemon/settings/settings.hpp"
#include "daemon/settings/settings_keys.hpp"

namespace deltamap::daemon {
namespace {

constexpr std::int64_t kNoLimit = std::numeric_limits<std::int64_t>::max();

SettingKey not_for_results(SettingKey key) {
  key.affects_result = false;
  return key;
}

}  // namespace

SettingKey of_both(SettingKey key, const double& value, double& other) {
  key.assign = [assign = std::move(key.assign), &value, &other](const SettingValue& given) {
    auto needed = assign(given);
    other = value;
    return needed;
  };
  return key;
}

namespace {

/// The same key, which also calls `note` whenever a setting assigns it; the default does not.
SettingKey noted(SettingKey key, std::function<void()> note) {
  key.assign = [assign = std::move(key.assign), note = std::move(note)](const SettingValue& given) {
    auto needed = assign(given);
    if (!needed) note();
    return needed;
  };
  return key;
}

/// A number that the driver keeps as one of several words.
SettingKey baud_key(std::string name, unsigned& field, std::vector<std::pair<std::string, unsigned>> bauds,
                    std::string meaning) {
  return not_for_results(choice_key(std::move(name), field, std::move(bauds), std::move(meaning)));
}

void add_robot(RobotSettings& robot, Keys& keys) {
  using std::pair;
  keys.push_back(not_for_results(text_key("robot.port", robot.port, "serial device of the robot's controller")));
  auto& session = robot.session;
  keys.push_back(word_key(
      "robot.model", {"p3dx", "p3dx-sh"}, [&session] { return session.model == "p3dx" ? 0u : 1u; },
      [&session](std::size_t index) { session.model = index == 0 ? "p3dx" : "p3dx-sh"; },
      "model that fixes the units of its odometry until the controller names itself"));
  keys.push_back(
      noted(number_key("robot.distance_unit_mm", robot.distance_unit_mm, "mm", 0.0, 10.0,
                       "unit of the odometry of a robot whose subtype is unknown; 0: by its subtype. Such a robot is "
                       "driven only where navigation.safety.robot_radius_m is given too"),
            [&robot, &session] {
              session.by_hand.metres_per_unit.reset();
              if (robot.distance_unit_mm > 0.0) session.by_hand.metres_per_unit = 1e-3 * robot.distance_unit_mm;
            }));
  keys.push_back(baud_key("robot.baud", session.baud,
                          {{"9600", 9600}, {"19200", 19200}, {"38400", 38400}, {"57600", 57600}, {"115200", 115200}},
                          "baud rate that is tried first; all others follow"));
  keys.push_back(baud_key("robot.fast_baud", session.fast_baud,
                          {{"0", 0}, {"19200", 19200}, {"38400", 38400}, {"57600", 57600}, {"115200", 115200}},
                          "baud rate switched to once connected, where the robot allows it; 0: stay"));
  keys.push_back(not_for_results(flag_key("robot.sonar", session.sonar, "whether the sonar is kept on")));
  keys.push_back(not_for_results(number_key("robot.max_speed_m_per_s", session.limits.max_speed_m_per_s, "m/s", 0.01,
                                            2.2, "no speed above it is ever sent to the robot")));
  keys.push_back(not_for_results(degrees_key("robot.max_turn_rate_deg_per_s", session.limits.max_turn_rate_rad_per_s,
                                             1.0, 500.0, "no turn rate above it is ever sent to the robot")));
  auto& limits = session.limits;
  keys.push_back(not_for_results(number_key("robot.acceleration_m_per_s2", limits.acceleration_m_per_s2, "m/s^2", 0.05,
                                            2.0, "acceleration that the controller is set to")));
  keys.push_back(
      not_for_results(number_key("robot.deceleration_m_per_s2", limits.deceleration_m_per_s2, "m/s^2", 0.1, 2.0,
                                 "deceleration that the controller is set to, for stops of its own too")));
  keys.push_back(not_for_results(degrees_key("robot.turn_acceleration_deg_per_s2", limits.turn_acceleration_rad_per_s2,
                                             10.0, 300.0, "acceleration of a turn that the controller is set to")));
  keys.push_back(not_for_results(
      degrees_key("robot.turn_deceleration_deg_per_s2", limits.turn_deceleration_rad_per_s2, 10.0, 300.0,
                  "deceleration of a turn that the controller is set to, for stops of its own too")));
}

void add_laser(LaserSettings& laser, double& range_deviation_m, Keys& keys) {
  using drivers::lms200::ScanVariant;
  using drivers::lms200::Units;
  auto& session = laser.session;
  keys.push_back(not_for_results(text_key("laser.port", laser.port, "serial device of the laser")));
  keys.push_back(baud_key("laser.baud", session.baud,
                          {{"9600", 9600}, {"19200", 19200}, {"38400", 38400}, {"500000", 500000}},
                          "baud rate that the laser is brought to"));
  const std::vector<std::string> variants{"180/1", "180/0.5", "100/1", "100/0.5", "100/0.25", "90/0.5"};
  const auto index_of_variant = [&session, variants] {
    std::size_t index = 0;
    while (index + 1 < variants.size() && drivers::lms200::name_of(session.variant) != variants[index]) ++index;
    return index;
  };
  keys.push_back(word_key(
      "laser.variant", variants, index_of_variant,
      [&session, variants](std::size_t index) {
        session.variant = drivers::lms200::variant_named(variants[index]).value_or(ScanVariant{});
      },
      "field of view / angular step, degrees"));
  keys.push_back(choice_key("laser.units", session.units, {{"cm", Units::kCentimetre}, {"mm", Units::kMillimetre}},
                            "step of a range; the laser is set to it, in its EEPROM"));
  keys.push_back(number_key("laser.max_range_m", session.max_range_m, "m", 0.0, 90.0,
                            "a longer range counts as no return; 0: as far as the laser's mode goes"));
  keys.push_back(with_symbol(number_key("laser.range_deviation_m", range_deviation_m, "m", 0.001, 1.0,
                                        "standard deviation of a range, laser and what it meets together"),
                             "σ_r"));
  keys.push_back(bearings_key(
      "laser.ignored_deg",
      [&session] {
        std::vector<double> bearings_deg;
        for (const auto& one : session.ignored)
          bearings_deg.insert(bearings_deg.end(), {degrees(one.from_rad), degrees(one.to_rad)});
        return bearings_deg;
      },
      [&session](const std::vector<double>& bearings_deg) {
        session.ignored.clear();
        for (std::size_t i = 0; i + 1 < bearings_deg.size(); i += 2)
          session.ignored.push_back({radians(bearings_deg[i]), radians(bearings_deg[i + 1])});
      },
      "bearings of the laser (0 ahead, left above 0) at which it sees the robot's own posts: neither obstacle nor "
      "map"));
  keys.push_back(number_key("laser.mount.x_m", session.robot_from_laser.x, "m", -5.0, 5.0,
                            "how far the laser is mounted ahead of the middle of the wheel axle"));
  keys.push_back(number_key("laser.mount.y_m", session.robot_from_laser.y, "m", -5.0, 5.0,
                            "how far the laser is mounted left of the middle of the wheel axle"));
  keys.push_back(degrees_key("laser.mount.yaw_deg", session.robot_from_laser.theta, -180.0, 180.0,
                             "how far the laser is mounted turned counter-clockwise"));
  keys.push_back(flag_key("laser.mount.upside_down", session.is_upside_down,
                          "the laser is mounted upside down: its values come from left to right"));
}

/// The mode `patrol` is reserved: naming it gives a reason of its own.
SettingKey drive_mode_key(navigation::DriveMode& mode) {
  using navigation::DriveMode;
  std::vector<std::pair<std::string, DriveMode>> modes;
  for (const DriveMode one : {DriveMode::kOff, DriveMode::kWander}) modes.emplace_back(name_of(one), one);
  SettingKey key = choice_key("navigation.mode", mode, modes, "who drives; off: the motors are never enabled");
  key.assign = [assign = key.assign](const SettingValue& value) -> std::optional<std::string> {
    const bool is_patrol = value.kind == SettingValue::Kind::kScalar && value.items.front() == "patrol";
    return is_patrol ? "off or wander (patrol does not exist yet)" : assign(value);
  };
  return key;
}

void add_navigation(NavigationSettings& settings, std::optional<double>& hull_by_hand_m, Keys& keys) {
  const auto add = [&keys](SettingKey key) { keys.push_back(not_for_results(std::move(key))); };
  add(drive_mode_key(settings.mode));
  add(flag_key("navigation.drive_without_pose", settings.drive_without_pose,
               "drive also while the pose is unknown, lost or called wrong; a robot that must find itself needs it"));
  const auto first_live = static_cast<std::ptrdiff_t>(keys.size());
  auto& safety = settings.safety;
  auto& wander = settings.wander;
  add(noted(of_both(number_key("navigation.safety.robot_radius_m", safety.robot_radius_m, "m", 0.05, 2.0,
                               "radius of the circle that the hull sweeps around the middle of the axle"),
                    safety.robot_radius_m, wander.robot_radius_m),
            [&safety, &hull_by_hand_m] { hull_by_hand_m = safety.robot_radius_m; }));
  add(number_key("navigation.safety.margin_m", safety.margin_m, "m", 0.0, 2.0,
                 "distance kept between the hull and everything"));
  add(number_key("navigation.safety.deceleration_m_per_s2", safety.deceleration_m_per_s2, "m/s^2", 0.05, 5.0,
                 "deceleration that safe speeds are computed with; the controller's own where that is less"));
  add(number_key("navigation.safety.max_speed_m_per_s", safety.max_speed_m_per_s, "m/s", 0.01, 2.2,
                 "speed at most, whatever the pilot wants"));
  add(degrees_key("navigation.safety.max_turn_rate_deg_per_s", safety.max_turn_rate_rad_per_s, 1.0, 500.0,
                  "turn rate at most, whatever the pilot wants"));
  add(of_both(number_key("navigation.safety.hidden_width_m", safety.obstacles.hidden_width_m, "m", 0.01, 2.0,
                         "width of an obstacle that a gap of beams without answer may hide"),
              safety.obstacles.hidden_width_m, wander.obstacles.hidden_width_m));
  add(number_key(
      "navigation.wander.speed_m_per_s", wander.speed_m_per_s, "m/s", 0.01, 2.2,
      "speed where the way is clear; never above robot.max_speed_m_per_s and navigation.safety.max_speed_m_per_s"));
  add(degrees_key("navigation.wander.turn_rate_deg_per_s", wander.turn_rate_rad_per_s, 1.0, 500.0,
                  "turn rate on the spot"));
  add(number_key("navigation.wander.side_clearance_m", wander.side_clearance_m, "m", 0.0, 5.0,
                 "distance kept to both sides while driving"));
  add(number_key("navigation.wander.shortest_leg_s", wander.shortest_leg_s, "s", 0.1, 3600.0,
                 "shortest time before the robot takes another direction"));
  add(number_key("navigation.wander.longest_leg_s", wander.longest_leg_s, "s", 0.1, 3600.0,
                 "longest time before the robot takes another direction"));
  std::for_each(keys.begin() + first_live, keys.end(), [](SettingKey& key) { key.is_live = true; });
}

void add_memory(MemorySettings& memory, Keys& keys) {
  keys.push_back(
      not_for_results(number_key("localization.memory.pose_period_s", memory.pose_period_s, "s", 0.1, 3600.0,
                                 "time between two writings of the pose beside map.store; what has proven to stay is "
                                 "written every twelfth time")));
}

void add_dashboard(DashboardSettings& dashboard, Keys& keys) {
  const auto add = [&keys](SettingKey key) { keys.push_back(not_for_results(std::move(key))); };
  add(text_key(
      "dashboard.address", dashboard.address,
      "IPv4 or IPv6 address that the live page listens on; one beyond this machine needs dashboard.token_file"));
  add(whole_key("dashboard.port", dashboard.port, "", 0, 65535, "TCP port of the live page; 0: no page"));
  add(text_key("dashboard.token_file", dashboard.token_file,
               "file whose first line every viewer is asked for; empty: nothing is asked"));
  add(flag_key("dashboard.control", dashboard.control,
               "whether the page may command as `deltamap ctl` does; what moves the robot needs a token as well"));
}

void add_recording(RecordingSettings& recording, Keys& keys) {
  const auto add = [&keys](SettingKey key) { keys.push_back(not_for_results(std::move(key))); };
  add(text_key("recording.file", recording.file, "pcapng recording of both ports; empty: none"));
  add(number_key("recording.max_gigabytes", recording.max_gigabytes, "GB", 0.001, 10000.0,
                 "size at which the recording ends, where it is no ring; the daemon goes on"));
  add(number_key("recording.keep_gigabytes", recording.keep_gigabytes, "GB", 0.0, 10000.0,
                 "makes the recording a ring of parts: the oldest go beyond this size; 0: no such rule"));
  add(number_key("recording.keep_hours", recording.keep_hours, "h", 0.0, 100000.0,
                 "makes the recording a ring of parts: those older than this go; 0: no such rule"));
}

void add_incidents(IncidentSettings& incidents, Keys& keys) {
  const auto add = [&keys](SettingKey key) { keys.push_back(not_for_results(std::move(key))); };
  add(text_key("incidents.folder", incidents.folder,
               "folder in which incidents are kept, each in a folder of its own; empty: none"));
  add(whole_key("incidents.max_count", incidents.max_count, "", 1, 100'000,
                "incidents at most; of those not pinned the oldest goes, marks and lost poses last"));
  add(number_key("incidents.max_gigabytes", incidents.max_gigabytes, "GB", 0.01, 10000.0,
                 "size of all incidents at most; of those not pinned the oldest goes, marks and lost poses last"));
}

std::optional<Contradiction> contradiction_in(const DashboardSettings& dashboard) {
  const auto is_loopback = dashboard::is_loopback(dashboard.address);
  if (!is_loopback) {
    return Contradiction{"dashboard.address", "needs an IPv4 or IPv6 address, not '" + dashboard.address + "'", {}};
  }
  if (*is_loopback || dashboard.port == 0 || !dashboard.token_file.empty()) return std::nullopt;
  return Contradiction{"dashboard.address",
                       "leads beyond this machine: that needs 'dashboard.token_file'",
                       {"dashboard.port", "dashboard.token_file"}};
}

}  // namespace

std::vector<SettingKey> keys_of(Settings& settings) {
  Keys keys;
  keys.push_back(whole_key("seed", settings.seed, "", 0, kNoLimit,
                           "seed of all randomness: the same bytes and seed give the same results"));
  add_robot(settings.robot, keys);
  add_laser(settings.laser, settings.localizer.range_deviation_m, keys);
  keys.push_back(not_for_results(
      with_symbol(text_key("map.file", settings.map.file, "first map: map_server YAML with its PGM or PNG"), "M_0")));
  keys.push_back(not_for_results(with_symbol(
      text_key("map.store", settings.map.store, "SQLite file of all map revisions; empty: they are not kept"), "M_k")));
  keys.push_back(not_for_results(
      text_key("map.newest", settings.map.newest,
               "YAML, with its PGM, of the newest revision for other programs, replaced in one step; empty: none")));
  keys.push_back(
      not_for_results(whole_key("map.retention.revisions", settings.map.retention.revisions, "", 0, 1'000'000'000,
                                "how many of the newest revisions stay one by one; 0: no such rule")));
  keys.push_back(not_for_results(number_key("map.retention.days", settings.map.retention.days, "days", 0.0, 36500.0,
                                            "age up to which revisions stay one by one; 0: no such rule")));
  keys.push_back(
      pose_key("localization.initial_pose", settings.initial_pose,
               "robot in the map at the first scan; null: where the run before left it, else found by itself"));
  add_localization_keys(settings.localizer, keys);
  add_memory(settings.memory, keys);
  add_mapping_keys(settings.mapping, keys);
  add_navigation(settings.navigation, settings.robot.session.by_hand.hull_m, keys);
  keys.push_back(not_for_results(text_key("control.socket", settings.control.socket,
                                          "socket on which `deltamap ctl` finds the daemon; empty: none")));
  keys.push_back(not_for_results(
      text_key("poses.socket", settings.poses.socket,
               "Unix socket that tells other programs the pose of every scan, a line of JSON each; empty: none")));
  add_dashboard(settings.dashboard, keys);
  add_recording(settings.recording, keys);
  add_incidents(settings.incidents, keys);
  keys.push_back(
      not_for_results(text_key("bays.file", settings.bays.file,
                               "YAML file of the bays whose state is told, read again by a reload; empty: none")));
  keys.push_back(not_for_results(text_key("zones.file", settings.zones.file,
                                          "YAML file of zones: never written, always transient, ignored, blocked, "
                                          "slow; read again by a reload; empty: none")));
  return keys;
}

std::vector<Contradiction> contradictions_in(const Settings& settings) {
  std::vector<Contradiction> found;
  const auto expect_not = [&](bool is_wrong, const std::string& key, const std::string& rule,
                              const std::vector<std::string>& others) {
    if (!is_wrong) return;
    std::string line = "must " + rule;
    for (const std::string& other : others) line += (&other == &others.front() ? " '" : " and '") + other + "'";
    found.push_back({key, std::move(line), others});
  };
  const auto& particles = settings.localizer.particles;
  expect_not(particles.min > particles.max, "localization.particles.min", "not exceed", {"localization.particles.max"});
  const auto& wander = settings.navigation.wander;
  expect_not(wander.shortest_leg_s > wander.longest_leg_s, "navigation.wander.shortest_leg_s", "not exceed",
             {"navigation.wander.longest_leg_s"});
  if (auto contradiction = contradiction_in(settings.dashboard)) found.push_back(*std::move(contradiction));
  if (settings.dashboard.control && settings.dashboard.port != 0 && settings.control.socket.empty()) {
    found.push_back({"dashboard.control",
                     "needs 'control.socket': one desk takes all commands",
                     {"control.socket", "dashboard.port"}});
  }
  return found;
}

}  // namespace deltamap::daemon
