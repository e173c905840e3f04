// SPDX-License-Identifier: Apache-2.0
// The table of keys: localization, as far as it follows a pose. What is believed of it: settings_keys_belief.cpp.
#include "daemon/settings/settings_keys.hpp"

namespace deltamap::daemon {
namespace {

void add_particles(localization::LocalizerParams& localizer, Keys& keys) {
  auto& particles = localizer.particles;
  keys.push_back(whole_key("localization.particles.min", particles.min, "", 10, 200000, "fewest particles"));
  keys.push_back(whole_key("localization.particles.max", particles.max, "", 10, 200000,
                           "most particles: what global localization starts with"));
  keys.push_back(with_symbol(number_key("localization.particles.resample_below", particles.resample_below, "", 0.0, 1.0,
                                        "N_eff / particles below which the particles are resampled"),
                             "N_eff, Eq. 5"));
  keys.push_back(
      number_key("localization.particles.evidence_beams", particles.evidence_beams, "", 0.1, 1000.0,
                 "independent beams that a whole scan counts as, for neighbouring beams see the same things"));
  keys.push_back(with_symbol(number_key("localization.particles.kld_error", particles.kld_error, "", 0.001, 1.0,
                                        "bound of the approximation error that sets the number of particles"),
                             "ε"));
  keys.push_back(with_symbol(number_key("localization.particles.kld_quantile", particles.kld_quantile, "", 0.1, 5.0,
                                        "quantile of the normal distribution: how surely the bound of kld_error holds"),
                             "z_(1-δ)"));
  keys.push_back(whole_key("localization.beams", localizer.beams, "", 0, 1000,
                           "beams of a scan that are weighed, evenly chosen among the valid ones; 0: all"));
  keys.push_back(number_key("localization.gap_s", localizer.gap_s, "s", 0.1, 1e9,
                            "time without scan and odometry after which the pose must prove itself again"));
  auto& update = localizer.update;
  keys.push_back(number_key("localization.update.distance_m", update.distance_m, "m", 0.0, 10.0,
                            "distance driven until a scan is weighed again"));
  keys.push_back(degrees_key("localization.update.turn_deg", update.turn_rad, 0.0, 180.0,
                             "angle turned until a scan is weighed again"));
  keys.push_back(number_key("localization.update.time_s", update.time_s, "s", 0.001, 3600.0,
                            "time passed until a scan is weighed again"));
}

void add_models(localization::LocalizerParams& localizer, Keys& keys) {
  auto& motion = localizer.motion;
  keys.push_back(with_symbol(number_key("localization.motion.turn_per_turn", motion.turn_per_turn, "rad/rad", 0.0, 10.0,
                                        "standard deviation of a turn, per radian of turn"),
                             "√α_1"));
  keys.push_back(with_symbol(degrees_key("localization.motion.turn_per_metre_deg", motion.turn_per_metre_rad, 0.0,
                                         180.0, "standard deviation of a turn, per metre driven"),
                             "√α_2"));
  keys.push_back(with_symbol(number_key("localization.motion.metre_per_metre", motion.metre_per_metre, "m/m", 0.0, 10.0,
                                        "standard deviation of a distance, per metre driven"),
                             "√α_3"));
  keys.push_back(with_symbol(number_key("localization.motion.metre_per_turn_m", motion.metre_per_turn_m, "m/rad", 0.0,
                                        10.0, "standard deviation of a distance, per radian of turn"),
                             "√α_4"));
  keys.push_back(number_key("localization.motion.position_floor_m", motion.position_floor_m, "m", 1e-6, 1.0,
                            "standard deviation of the position that every step gets, moved or not"));
  keys.push_back(degrees_key("localization.motion.heading_floor_deg", motion.heading_floor_rad, 1e-6, 90.0,
                             "standard deviation of the heading that every step gets, moved or not"));
  keys.push_back(number_key("localization.motion.unknown_speed_m_per_s", motion.unknown_speed_m_per_s, "m/s", 0.0, 10.0,
                            "standard deviation of the position, per second without odometry"));
  keys.push_back(degrees_key("localization.motion.unknown_turn_rate_deg_per_s", motion.unknown_turn_rate_rad_per_s, 0.0,
                             360.0, "standard deviation of the heading, per second without odometry"));
  keys.push_back(number_key("localization.motion.slip_probability", motion.slip_probability, "", 0.0, 0.1,
                            "probability of a step that the wheels slip or someone pushes the robot; 0: never"));
  keys.push_back(number_key("localization.motion.slip_m", motion.slip_m, "m", 0.001, 10.0,
                            "standard deviation of the position after a slip"));
  keys.push_back(degrees_key("localization.motion.slip_deg", motion.slip_rad, 0.01, 180.0,
                             "standard deviation of the heading after a slip"));
  auto& wheels = localizer.track.wheels;
  keys.push_back(number_key("localization.wheels.metre_per_root_metre", wheels.metre_per_root_metre, "m", 0.0001, 10.0,
                            "standard deviation of a distance after one metre, before anything was learned"));
  keys.push_back(degrees_key("localization.wheels.turn_per_root_metre_deg", wheels.turn_per_root_metre_rad, 0.01, 90.0,
                             "standard deviation of the heading after one metre, before anything was learned"));
  keys.push_back(
      degrees_key("localization.wheels.turn_per_root_turn_deg", wheels.turn_per_root_turn_rad, 0.01, 90.0,
                  "standard deviation of the heading after one radian of turn, before anything was learned"));
  keys.push_back(number_key("localization.wheels.learning_share", wheels.learning_share, "", 0.0, 0.9,
                            "weight of one stretch in the learned quality of the wheels; 0: never learn"));
  keys.push_back(number_key("localization.wheels.stretch_m", wheels.stretch_m, "m", 0.1, 100.0,
                            "distance over which wheels and scans are compared, unless stretch_deg is turned first"));
  keys.push_back(degrees_key("localization.wheels.stretch_deg", wheels.stretch_rad, 1.0, 3600.0,
                             "turn over which wheels and scans are compared, unless stretch_m is driven first"));
  auto& odometry = localizer.odometry;
  keys.push_back(number_key("localization.odometry.extrapolation_s", odometry.extrapolation_s, "s", 0.0, 1.0,
                            "longest extrapolation past the newest odometry report"));
  keys.push_back(number_key("localization.odometry.max_speed_m_per_s", odometry.max_speed_m_per_s, "m/s", 0.01, 10.0,
                            "speed of the robot at most: faster odometry is clamped"));
  keys.push_back(degrees_key("localization.odometry.max_turn_rate_deg_per_s", odometry.max_turn_rate_rad_per_s, 1.0,
                             1000.0, "turn rate of the robot at most: faster odometry is clamped"));
  auto& field = localizer.field;
  keys.push_back(
      with_symbol(number_key("localization.field.hit_deviation_m", field.hit_deviation_m, "m", 0.001, 2.0,
                             "standard deviation of a range, laser and map together; at least 0.7 cells are used"),
                  "σ_hit"));
  keys.push_back(with_symbol(number_key("localization.field.random_share", field.random_share, "", 0.02, 0.5,
                                        "share of beams that hit what no map knows"),
                             "z_rand"));
  keys.push_back(number_key("localization.field.unknown_likelihood", field.unknown_likelihood, "", 0.02, 1.0,
                            "likelihood of a beam that ends in unknown space"));
  auto& refinement = localizer.refinement;
  keys.push_back(whole_key("localization.refinement.steps", refinement.steps, "", 0, 30,
                           "Gauss-Newton steps of the pose refinement at most; 0: no refinement"));
  keys.push_back(number_key("localization.refinement.prior_share", refinement.prior_share, "", 0.0, 10.0,
                            "how strongly the particles' covariance holds the refined pose; 0: not at all"));
  keys.push_back(number_key("localization.refinement.longest_shift_m", refinement.longest_shift_m, "m", 0.001, 10.0,
                            "a refined pose farther from the particles' mean is refused"));
  keys.push_back(degrees_key("localization.refinement.largest_turn_deg", refinement.largest_turn_rad, 0.01, 180.0,
                             "a refined pose turned farther from the particles' mean is refused"));
  keys.push_back(number_key("localization.refinement.range_deviation_m", refinement.range_deviation_m, "m", 0.0001, 1.0,
                            "standard deviation of the laser's ranges; end points that scatter more show a rough map"));
  keys.push_back(number_key("localization.refinement.alike_beams", refinement.alike_beams, "", 1.0, 10000.0,
                            "number of beams, of this and other scans, that share one error of the map"));
  keys.push_back(number_key("localization.track.agreement", localizer.track.agreement, "", 0.1, 100.0,
                            "standard deviations of the particles within which the estimate goes on from scan to scan; "
                            "beyond, the particles are right"));
  keys.push_back(
      flag_key("localization.track.surfaces", localizer.follow_surfaces,
               "whether straight surfaces lead the pose where they explain the scans; false: particles always do"));
}

void add_temporary(localization::sensor::TransientBeamsParams& temporary, Keys& keys) {
  const std::string at = "localization.temporary.";
  keys.push_back(flag_key(at + "weighing", temporary.weighing,
                          "leave beams that end at a temporary obstacle out of the weights of the particles"));
  keys.push_back(flag_key(at + "belief", temporary.belief,
                          "leave beams that end at a temporary obstacle out of the evidence against the pose; a wrong "
                          "pose is noticed later"));
  keys.push_back(number_key(at + "least_share_left", temporary.least_share_left, "", 0.0, 1.0,
                            "share of a scan's beams that must be left; where fewer would be, all are weighed"));
}

}  // namespace

void add_localization_keys(localization::LocalizerParams& localizer, Keys& keys) {
  add_particles(localizer, keys);
  add_models(localizer, keys);
  add_temporary(localizer.temporary, keys);
}

}  // namespace deltamap::daemon
