// SPDX-License-Identifier: Apache-2.0
// The table of keys: what config/default.yaml lists, in its order.
#include <algorithm>
#include <limits>
#include <utility>

#include "daemon/settings.hpp"

namespace deltamap::daemon {
namespace {

constexpr double kUnlimited = std::numeric_limits<double>::max();
constexpr std::int64_t kNoLimit = std::numeric_limits<std::int64_t>::max();

using Keys = std::vector<SettingKey>;

SettingKey not_for_results(SettingKey key) {
  key.affects_result = false;
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
      "units of its odometry until it names itself"));
  keys.push_back(baud_key("robot.baud", session.baud,
                          {{"9600", 9600}, {"19200", 19200}, {"38400", 38400}, {"57600", 57600}, {"115200", 115200}},
                          "speed that is tried first; all others follow"));
  keys.push_back(baud_key("robot.fast_baud", session.fast_baud,
                          {{"0", 0}, {"19200", 19200}, {"38400", 38400}, {"57600", 57600}, {"115200", 115200}},
                          "switched to once connected, where the robot allows it; 0 stays"));
  keys.push_back(not_for_results(flag_key("robot.sonar", session.sonar, "keep the sonar on")));
  keys.push_back(not_for_results(number_key("robot.max_speed_m_per_s", session.max_speed_m_per_s, "m/s", 0.01, 2.2,
                                            "set points are clamped to it")));
  keys.push_back(not_for_results(degrees_key("robot.max_turn_rate_deg_per_s", session.max_turn_rate_rad_per_s, 1.0,
                                             500.0, "set points are clamped to it")));
  keys.push_back(not_for_results(number_key("robot.pulse_interval_s", session.pulse_interval_s, "s", 0.05, 1.5,
                                            "the robot hears from us at least this often")));
  keys.push_back(not_for_results(number_key("robot.sip_timeout_s", session.sip_timeout_s, "s", 0.2, 60.0,
                                            "silence after which the robot counts as gone")));
}

void add_laser(LaserSettings& laser, Keys& keys) {
  using drivers::lms200::ScanVariant;
  using drivers::lms200::Units;
  auto& session = laser.session;
  keys.push_back(not_for_results(text_key("laser.port", laser.port, "serial device of the laser")));
  keys.push_back(baud_key("laser.baud", session.baud,
                          {{"9600", 9600}, {"19200", 19200}, {"38400", 38400}, {"500000", 500000}},
                          "speed that the laser is brought to"));
  const std::vector<std::string> variants{"180/1", "180/0.5", "100/1", "100/0.5", "100/0.25"};
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
      "field of view and step, degrees"));
  keys.push_back(choice_key("laser.units", session.units, {{"cm", Units::kCentimetre}, {"mm", Units::kMillimetre}},
                            "step of a range"));
  keys.push_back(number_key("laser.max_range_m", session.max_range_m, "m", 0.0, 90.0,
                            "longer ranges are no returns; 0: as far as the laser's mode goes"));
  keys.push_back(
      number_key("laser.mount.x_m", session.robot_from_laser.x, "m", -5.0, 5.0, "laser ahead of the robot's centre"));
  keys.push_back(
      number_key("laser.mount.y_m", session.robot_from_laser.y, "m", -5.0, 5.0, "laser left of the robot's centre"));
  keys.push_back(degrees_key("laser.mount.yaw_deg", session.robot_from_laser.theta, -180.0, 180.0,
                             "laser turned counter-clockwise"));
  keys.push_back(not_for_results(number_key("laser.power_on_wait_s", session.power_on_wait_s, "s", 0.0, 600.0,
                                            "how long a silent laser may still be starting up")));
  keys.push_back(not_for_results(number_key("laser.scan_timeout_s", session.scan_timeout_s, "s", 0.2, 60.0,
                                            "silence after which the laser counts as gone")));
}

void add_particles(localization::LocalizerParams& localizer, Keys& keys) {
  auto& particles = localizer.particles;
  keys.push_back(whole_key("localization.particles.min", particles.min, "", 10, 200000, "fewest particles"));
  keys.push_back(whole_key("localization.particles.max", particles.max, "", 10, 200000,
                           "most particles; global localization begins with them"));
  keys.push_back(number_key("localization.particles.resample_below", particles.resample_below, "", 0.0, 1.0,
                            "share of the particles below which N_eff (Eq. 5) calls for resampling"));
  keys.push_back(number_key("localization.particles.evidence_beams", particles.evidence_beams, "", 0.1, 1000.0,
                            "independent beams that a whole scan counts as"));
  keys.push_back(number_key("localization.particles.kld_error", particles.kld_error, "", 0.001, 1.0,
                            "bound of the approximation error that sets their number"));
  keys.push_back(number_key("localization.particles.kld_quantile", particles.kld_quantile, "", 0.1, 5.0,
                            "how surely the bound holds"));
  keys.push_back(whole_key("localization.beams", localizer.beams, "", 0, 1000, "beams of a scan that score; 0: all"));
  auto& update = localizer.update;
  keys.push_back(number_key("localization.update.distance_m", update.distance_m, "m", 0.0, 10.0,
                            "driven until a scan is weighed again"));
  keys.push_back(
      degrees_key("localization.update.turn_deg", update.turn_rad, 0.0, 180.0, "turned until a scan is weighed again"));
  keys.push_back(number_key("localization.update.time_s", update.time_s, "s", 0.001, 3600.0,
                            "passed until a scan is weighed again"));
}

void add_models(localization::LocalizerParams& localizer, Keys& keys) {
  auto& motion = localizer.motion;
  keys.push_back(number_key("localization.motion.turn_per_turn", motion.turn_per_turn, "rad/rad", 0.0, 10.0,
                            "deviation of a turn by turning"));
  keys.push_back(degrees_key("localization.motion.turn_per_metre_deg", motion.turn_per_metre_rad, 0.0, 180.0,
                             "deviation of a turn by driving a metre"));
  keys.push_back(number_key("localization.motion.metre_per_metre", motion.metre_per_metre, "m/m", 0.0, 10.0,
                            "deviation of a distance by driving"));
  keys.push_back(number_key("localization.motion.metre_per_turn_m", motion.metre_per_turn_m, "m/rad", 0.0, 10.0,
                            "deviation of a distance by turning"));
  keys.push_back(number_key("localization.motion.position_floor_m", motion.position_floor_m, "m", 1e-6, 1.0,
                            "deviation of every step"));
  keys.push_back(degrees_key("localization.motion.heading_floor_deg", motion.heading_floor_rad, 1e-6, 90.0,
                             "deviation of every step"));
  keys.push_back(number_key("localization.motion.unknown_speed_m_per_s", motion.unknown_speed_m_per_s, "m/s", 0.0, 10.0,
                            "deviation a second without odometry"));
  keys.push_back(degrees_key("localization.motion.unknown_turn_rate_deg_per_s", motion.unknown_turn_rate_rad_per_s, 0.0,
                             360.0, "deviation a second without odometry"));
  auto& odometry = localizer.odometry;
  keys.push_back(number_key("localization.odometry.extrapolation_s", odometry.extrapolation_s, "s", 0.0, 1.0,
                            "longest reach past the newest report"));
  keys.push_back(number_key("localization.odometry.max_speed_m_per_s", odometry.max_speed_m_per_s, "m/s", 0.01, 10.0,
                            "of the robot: faster readings are clamped"));
  keys.push_back(degrees_key("localization.odometry.max_turn_rate_deg_per_s", odometry.max_turn_rate_rad_per_s, 1.0,
                             1000.0, "of the robot: faster readings are clamped"));
  auto& field = localizer.field;
  keys.push_back(number_key("localization.field.hit_deviation_m", field.hit_deviation_m, "m", 0.001, 2.0,
                            "of laser and map together (sigma_hit)"));
  keys.push_back(number_key("localization.field.random_share", field.random_share, "", 0.02, 0.5,
                            "share of beams that hit what no map knows (z_rand)"));
  keys.push_back(number_key("localization.field.unknown_likelihood", field.unknown_likelihood, "", 0.02, 1.0,
                            "of a beam that ends in unknown space"));
  auto& refinement = localizer.refinement;
  keys.push_back(
      whole_key("localization.refinement.steps", refinement.steps, "", 0, 30, "Gauss-Newton steps at most; 0: off"));
  keys.push_back(number_key("localization.refinement.prior_share", refinement.prior_share, "", 0.0, 10.0,
                            "how strongly the particles hold the pose"));
  keys.push_back(number_key("localization.refinement.longest_shift_m", refinement.longest_shift_m, "m", 0.001, 10.0,
                            "a pose refined farther is refused"));
  keys.push_back(degrees_key("localization.refinement.largest_turn_deg", refinement.largest_turn_rad, 0.01, 180.0,
                             "a pose refined farther is refused"));
}

void add_states(localization::LocalizerParams& localizer, Keys& keys) {
  auto& hypothesis = localizer.hypothesis;
  keys.push_back(number_key("localization.hypothesis.cell_m", hypothesis.cell_m, "m", 0.01, 10.0,
                            "particles in neighbouring cells belong together"));
  keys.push_back(degrees_key("localization.hypothesis.heading_cell_deg", hypothesis.heading_cell_rad, 1.0, 90.0,
                             "height of such a cell"));
  auto& fit = localizer.fit;
  keys.push_back(number_key("localization.fit.lost_below", fit.lost_below, "", 0.0, 1.0,
                            "mean share of beams that the map explains: misfit below"));
  keys.push_back(number_key("localization.fit.found_above", fit.found_above, "", 0.0, 1.0, "and found again above"));
  keys.push_back(
      number_key("localization.fit.lost_after_s", fit.lost_after_s, "s", 0.001, 3600.0, "unbroken misfit until lost"));
  keys.push_back(
      number_key("localization.fit.memory_s", fit.memory_s, "s", 0.001, 3600.0, "time constant of that mean"));
  keys.push_back(number_key("localization.fit.search_after_s", fit.search_after_s, "s", 0.0, 86400.0,
                            "lost until the whole map is searched"));
  keys.push_back(
      number_key("localization.fit.search_after_m", fit.search_after_m, "m", 0.0, 1000.0, "and driven since"));
  keys.push_back(number_key("localization.fit.converged_share", fit.converged_share, "", 0.5, 1.0,
                            "weight of the best hypothesis that ends global localization"));
  keys.push_back(number_key("localization.fit.converged_m", fit.converged_m, "m", 0.001, 10.0,
                            "its deviation that ends global localization"));
  keys.push_back(degrees_key("localization.fit.converged_deg", fit.converged_rad, 0.1, 180.0,
                             "its deviation that ends global localization"));
  keys.push_back(number_key("localization.fit.converged_after_m", fit.converged_after_m, "m", 0.0, 1000.0,
                            "driven before global localization may end"));
  keys.push_back(
      degrees_key("localization.fit.converged_after_deg", fit.converged_after_rad, 0.0, 3600.0, "or turned"));
  auto& global = localizer.global;
  keys.push_back(number_key("localization.global.candidates_per_m2", global.candidates_per_m2, "1/m2", 0.1, 10000.0,
                            "poses drawn over free space"));
  keys.push_back(whole_key("localization.global.most_candidates", global.most_candidates, "", 1, 10000000,
                           "however large the map"));
  keys.push_back(whole_key("localization.global.beams", global.beams, "", 1, 1000, "beams that judge a candidate"));
  keys.push_back(whole_key("localization.global.places", global.places, "", 1, 100000,
                           "candidates that are slid to their best fit"));
  keys.push_back(number_key("localization.global.evidence_beams", global.evidence_beams, "", 0.1, 1000.0,
                            "independent beams that the scan counts as; low keeps more places"));
  keys.push_back(number_key("localization.global.jitter_m", global.jitter_m, "m", 0.0, 10.0,
                            "spread of the particles around a place"));
  keys.push_back(degrees_key("localization.global.jitter_deg", global.jitter_rad, 0.0, 180.0,
                             "spread of the particles around a place"));
}

void add_evidence(mapping::awareness::EvidencePhaseParams& evidence, Keys& keys) {
  keys.push_back(number_key("mapping.persistence_s", evidence.persistence_s, "s", 0.0, 86400.0,
                            "how long a difference must last to become map"));
  const std::string at = "mapping.evidence.";
  keys.push_back(number_key(at + "least_votes", evidence.least_votes, "", 0.1, 1000.0, "keyframes that must say so"));
  keys.push_back(number_key(at + "least_added_share", evidence.least_added_share, "", 0.5, 1.0,
                            "of the votes on a block that say added"));
  keys.push_back(number_key(at + "least_removed_share", evidence.least_removed_share, "", 0.5, 1.0,
                            "of the votes on a block that say removed"));
  keys.push_back(
      whole_key(at + "least_blocks", evidence.least_blocks, "", 1, 10000, "a smaller region is a speck and waits"));
  keys.push_back(number_key(at + "settle_s", evidence.settle_s, "s", 0.0, 3600.0,
                            "a region is handed on when it has not grown for so long"));
  keys.push_back(number_key(at + "most_wait_s", evidence.most_wait_s, "s", 0.0, 3600.0, "or has waited so long"));
  keys.push_back(
      number_key(at + "most_range_m", evidence.beams.most_range_m, "m", 0.1, 100.0, "a beam says nothing beyond"));
  keys.push_back(
      number_key(at + "range_deviation_m", evidence.beams.range_deviation_m, "m", 0.001, 1.0, "of the laser"));
  keys.push_back(number_key(at + "forget_s", evidence.votes.forget_s, "s", 1.0, 86400.0,
                            "without votes until a block starts anew"));
}

void add_mapping(MappingSettings& settings, Keys& keys) {
  keys.push_back(flag_key("mapping.enabled", settings.enabled, "let the map follow the world"));
  auto& store_scan = settings.store_scan;
  keys.push_back(choice_key("mapping.method", store_scan.method,
                            {{"paper", MappingMethod::kPaper}, {"evidence", MappingMethod::kEvidence}},
                            "how changes are found and merged"));
  add_evidence(store_scan.evidence, keys);
  auto& ratio = store_scan.divergence;
  keys.push_back(
      number_key("mapping.paper.alpha_slow", ratio.alpha_slow, "", 1e-6, 1.0, "long-term rate a scan (Eq. 2)"));
  keys.push_back(
      number_key("mapping.paper.alpha_fast", ratio.alpha_fast, "", 1e-6, 1.0, "short-term rate a scan (Eq. 2)"));
  auto& phase = store_scan.delta_phase;
  keys.push_back(number_key("mapping.paper.least_n_eff_share", phase.least_n_eff_share, "", 0.0, 1.0,
                            "N_eff / particles (Eq. 5) below which a scan is not kept"));
  keys.push_back(whole_key("mapping.paper.most_scans", phase.most_scans, "", 2, 100000, "kept in one phase"));
}

void add_navigation(NavigationSettings& settings, Keys& keys) {
  using navigation::DriveMode;
  const auto add = [&keys](SettingKey key) { keys.push_back(not_for_results(std::move(key))); };
  add(choice_key("navigation.mode", settings.mode, {{"off", DriveMode::kOff}, {"wander", DriveMode::kWander}},
                 "who drives; off: motors are never enabled"));
  auto& safety = settings.safety;
  add(number_key("navigation.safety.robot_radius_m", safety.robot_radius_m, "m", 0.05, 2.0,
                 "swing circle around the axle"));
  add(number_key("navigation.safety.margin_m", safety.margin_m, "m", 0.0, 2.0, "kept between the hull and everything"));
  add(number_key("navigation.safety.deceleration_m_per_s2", safety.deceleration_m_per_s2, "m/s2", 0.05, 5.0,
                 "what the controller brakes with"));
  add(number_key("navigation.safety.reaction_s", safety.reaction_s, "s", 0.0, 2.0, "from a decision to the wheels"));
  add(number_key("navigation.safety.command_life_s", safety.command_life_s, "s", 0.05, 2.0,
                 "a drive command older than that is void"));
  add(number_key("navigation.safety.odometry_life_s", safety.odometry_life_s, "s", 0.1, 5.0,
                 "silence of the robot after which it must stand"));
  add(number_key("navigation.safety.max_speed_m_per_s", safety.max_speed_m_per_s, "m/s", 0.01, 2.2,
                 "whatever the pilot wants"));
  add(degrees_key("navigation.safety.max_turn_rate_deg_per_s", safety.max_turn_rate_rad_per_s, 1.0, 500.0,
                  "whatever the pilot wants"));
  add(number_key("navigation.safety.hidden_width_m", safety.obstacles.hidden_width_m, "m", 0.01, 2.0,
                 "what a gap of beams without answer may hide"));
  auto& wander = settings.wander;
  add(number_key("navigation.wander.speed_m_per_s", wander.speed_m_per_s, "m/s", 0.01, 2.2, "where it is clear"));
  add(degrees_key("navigation.wander.turn_rate_deg_per_s", wander.turn_rate_rad_per_s, 1.0, 500.0, "on the spot"));
  add(number_key("navigation.wander.side_clearance_m", wander.side_clearance_m, "m", 0.0, 5.0,
                 "kept to both sides while driving"));
  add(number_key("navigation.wander.turn_away_m", wander.turn_away_m, "m", 0.05, 10.0,
                 "free path at which it stops and turns"));
  add(number_key("navigation.wander.slow_down_m", wander.slow_down_m, "m", 0.05, 20.0,
                 "free path below which it goes slower"));
  add(number_key("navigation.wander.go_on_m", wander.go_on_m, "m", 0.05, 20.0, "free path that ends a turn"));
  add(number_key("navigation.wander.shortest_leg_s", wander.shortest_leg_s, "s", 0.1, 3600.0,
                 "before it thinks of another direction"));
  add(number_key("navigation.wander.longest_leg_s", wander.longest_leg_s, "s", 0.1, 3600.0,
                 "before it thinks of another direction"));
}

}  // namespace

std::vector<SettingKey> keys_of(Settings& settings) {
  Keys keys;
  keys.push_back(
      whole_key("seed", settings.seed, "", 0, kNoLimit, "of all randomness: same bytes and seed, same results"));
  add_robot(settings.robot, keys);
  add_laser(settings.laser, keys);
  keys.push_back(not_for_results(text_key("map.file", settings.map.file, "M_0: map_server YAML with its PGM")));
  keys.push_back(
      not_for_results(text_key("map.store", settings.map.store, "SQLite file of all revisions; empty: not kept")));
  keys.push_back(pose_key("localization.initial_pose", settings.initial_pose,
                          "robot in the map at the first scan; null: found by itself"));
  add_particles(settings.localizer, keys);
  add_models(settings.localizer, keys);
  add_states(settings.localizer, keys);
  add_mapping(settings.mapping, keys);
  add_navigation(settings.navigation, keys);
  keys.push_back(
      not_for_results(text_key("recording.file", settings.recording.file, "pcapng of both ports; empty: none")));
  keys.push_back(not_for_results(number_key("recording.max_gigabytes", settings.recording.max_gigabytes, "GB", 0.001,
                                            10000.0, "the recording ends there, the daemon goes on")));
  return keys;
}

std::optional<std::string> contradiction_in(const Settings& settings) {
  const auto& localizer = settings.localizer;
  if (localizer.particles.min > localizer.particles.max) {
    return "'localization.particles.min' must not exceed 'localization.particles.max'";
  }
  if (localizer.fit.lost_below > localizer.fit.found_above) {
    return "'localization.fit.lost_below' must not exceed 'localization.fit.found_above'";
  }
  if (localizer.field.unknown_likelihood < localizer.field.random_share) {
    return "'localization.field.unknown_likelihood' must not lie below 'localization.field.random_share'";
  }
  const auto& wander = settings.navigation.wander;
  if (wander.shortest_leg_s > wander.longest_leg_s) {
    return "'navigation.wander.shortest_leg_s' must not exceed 'navigation.wander.longest_leg_s'";
  }
  if (wander.turn_away_m >= std::min(wander.slow_down_m, wander.go_on_m)) {
    return "'navigation.wander.turn_away_m' must lie below 'navigation.wander.slow_down_m' and "
           "'navigation.wander.go_on_m'";
  }
  return std::nullopt;
}

}  // namespace deltamap::daemon
