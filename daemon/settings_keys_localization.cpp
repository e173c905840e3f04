// SPDX-License-Identifier: Apache-2.0
// The table of keys: localization, as far as it follows a pose. What is believed of it: settings_keys_belief.cpp.
#include "daemon/settings_keys.hpp"

namespace deltamap::daemon {
namespace {

void add_particles(localization::LocalizerParams& localizer, Keys& keys) {
  auto& particles = localizer.particles;
  keys.push_back(whole_key("localization.particles.min", particles.min, "", 10, 200000, "fewest particles"));
  keys.push_back(whole_key("localization.particles.max", particles.max, "", 10, 200000, "most particles"));
  keys.push_back(number_key("localization.particles.resample_below", particles.resample_below, "", 0.0, 1.0,
                            "share of the particles below which N_eff (Eq. 5) calls for resampling"));
  keys.push_back(number_key("localization.particles.evidence_beams", particles.evidence_beams, "", 0.1, 1000.0,
                            "independent beams that a whole scan counts as"));
  keys.push_back(number_key("localization.particles.kld_error", particles.kld_error, "", 0.001, 1.0,
                            "bound of the approximation error that sets their number"));
  keys.push_back(number_key("localization.particles.kld_quantile", particles.kld_quantile, "", 0.1, 5.0,
                            "how surely the bound holds"));
  keys.push_back(whole_key("localization.beams", localizer.beams, "", 0, 1000, "beams of a scan that score; 0: all"));
  keys.push_back(number_key("localization.gap_s", localizer.gap_s, "s", 0.1, 1e9,
                            "without scan and odometry, after which the pose must prove itself again"));
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
  keys.push_back(number_key("localization.motion.slip_probability", motion.slip_probability, "", 0.0, 0.1,
                            "that wheels slip or someone pushes, a step; 0: never"));
  keys.push_back(number_key("localization.motion.slip_m", motion.slip_m, "m", 0.001, 10.0,
                            "deviation of what is then lost or made up"));
  keys.push_back(degrees_key("localization.motion.slip_deg", motion.slip_rad, 0.01, 180.0, "likewise of the heading"));
  auto& wheels = localizer.track.wheels;
  keys.push_back(number_key("localization.wheels.metre_per_root_metre", wheels.metre_per_root_metre, "m", 0.0001, 10.0,
                            "deviation of a distance after one metre, before anything was learned"));
  keys.push_back(degrees_key("localization.wheels.turn_per_root_metre_deg", wheels.turn_per_root_metre_rad, 0.01, 90.0,
                             "deviation of the heading after one metre, likewise"));
  keys.push_back(degrees_key("localization.wheels.turn_per_root_turn_deg", wheels.turn_per_root_turn_rad, 0.01, 90.0,
                             "deviation of the heading after one radian of turn, likewise"));
  keys.push_back(number_key("localization.wheels.learning_share", wheels.learning_share, "", 0.0, 0.9,
                            "weight of one stretch in how good the wheels have shown to be; 0: never learn"));
  keys.push_back(number_key("localization.wheels.stretch_m", wheels.stretch_m, "m", 0.1, 100.0,
                            "way over which wheels and scans are compared"));
  keys.push_back(degrees_key("localization.wheels.stretch_deg", wheels.stretch_rad, 1.0, 3600.0, "or turn"));
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
  keys.push_back(number_key("localization.refinement.range_deviation_m", refinement.range_deviation_m, "m", 0.0001, 1.0,
                            "of the laser; ends that scatter more show a rough map"));
  keys.push_back(number_key("localization.refinement.alike_beams", refinement.alike_beams, "", 1.0, 10000.0,
                            "beams, of this and other scans, that share an error of the map"));
  keys.push_back(number_key("localization.track.agreement", localizer.track.agreement, "", 0.1, 100.0,
                            "deviations of the particles within which the estimate goes on from scan to scan"));
  keys.push_back(flag_key("localization.track.surfaces", localizer.follow_surfaces,
                          "where straight surfaces explain the scans they lead, moved or not, and the particles rest"));
}

void add_temporary(localization::TemporaryBeamsParams& temporary, Keys& keys) {
  const std::string at = "localization.temporary.";
  keys.push_back(flag_key(at + "weighing", temporary.weighing,
                          "leave beams that end at what stands there for now out of weighing"));
  keys.push_back(flag_key(at + "belief", temporary.belief,
                          "and out of what speaks against the pose; slower to notice a wrong one"));
  keys.push_back(number_key(at + "least_share_left", temporary.least_share_left, "", 0.0, 1.0,
                            "of a scan's beams; where fewer would be left, all weigh"));
}

}  // namespace

void add_localization_keys(localization::LocalizerParams& localizer, Keys& keys) {
  add_particles(localizer, keys);
  add_models(localizer, keys);
  add_temporary(localizer.temporary, keys);
}

}  // namespace deltamap::daemon
