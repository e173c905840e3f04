// SPDX-License-Identifier: Apache-2.0
// The table of keys: localization. Which figure is a key: docs/decisions/settings-schema.md.
#include "daemon/settings/settings_keys.hpp"

namespace deltamap::daemon {
namespace {

void add_particles(localization::LocalizerParams& localizer, Keys& keys) {
  const std::string at = "localization.particles.";
  auto& particles = localizer.particles;
  keys.push_back(whole_key(at + "min", particles.min, "", 10, 200000, "fewest particles"));
  keys.push_back(
      whole_key(at + "max", particles.max, "", 10, 200000,
                "most particles: so many are drawn where the pose is unsure by more than 0.15 m or 4 degrees"));
  keys.push_back(with_symbol(number_key(at + "resample_below", particles.resample_below, "", 0.0, 1.0,
                                        "N_eff / particles below which the particles are resampled"),
                             "N_eff, Eq. 5"));
  keys.push_back(with_symbol(number_key(at + "kld_error", particles.kld_error, "", 0.001, 1.0,
                                        "bound of the approximation error that sets the number of particles"),
                             "ε"));
  keys.push_back(with_symbol(number_key(at + "kld_quantile", particles.kld_quantile, "", 0.1, 5.0,
                                        "quantile of the normal distribution: how surely the bound of kld_error holds"),
                             "z_(1-δ)"));
  auto& update = localizer.update;
  keys.push_back(number_key("localization.update.distance_m", update.distance_m, "m", 0.0, 10.0,
                            "distance driven until a scan is weighed again"));
  keys.push_back(degrees_key("localization.update.turn_deg", update.turn_rad, 0.0, 180.0,
                             "angle turned until a scan is weighed again"));
}

void add_wheels(localization::LocalizerParams& localizer, Keys& keys) {
  const std::string at = "localization.motion.";
  auto& motion = localizer.motion;
  keys.push_back(with_symbol(number_key(at + "turn_per_turn", motion.turn_per_turn, "rad/rad", 0.0, 10.0,
                                        "standard deviation of a turn, per radian of turn"),
                             "√α_1"));
  keys.push_back(with_symbol(degrees_key(at + "turn_per_metre_deg", motion.turn_per_metre_rad, 0.0, 180.0,
                                         "standard deviation of a turn, per metre driven"),
                             "√α_2"));
  keys.push_back(with_symbol(number_key(at + "metre_per_metre", motion.metre_per_metre, "m/m", 0.0, 10.0,
                                        "standard deviation of a distance, per metre driven"),
                             "√α_3"));
  keys.push_back(with_symbol(number_key(at + "metre_per_turn_m", motion.metre_per_turn_m, "m/rad", 0.0, 10.0,
                                        "standard deviation of a distance, per radian of turn"),
                             "√α_4"));
  keys.push_back(number_key(
      at + "slip_probability", motion.slip_probability, "", 0.0, 0.1,
      "probability that the wheels slip, or someone pushes the robot, in one step of the motion model; 0: never"));
  keys.push_back(number_key("localization.wheels.learning_share", localizer.wheels.learning_share, "", 0.0, 0.9,
                            "weight of the newest stretch in the learned noise of the wheels; 0: never learn"));
}

void add_sensor(localization::LocalizerParams& localizer, Keys& keys) {
  auto& field = localizer.field;
  keys.push_back(with_symbol(number_key("localization.field.hit_deviation_m", field.hit_deviation_m, "m", 0.001, 2.0,
                                        "how far from a wall of the map a beam may end and still fit, standard "
                                        "deviation; at least 0.7 cells are used"),
                             "σ_hit"));
  keys.push_back(with_symbol(number_key("localization.field.random_share", field.random_share, "", 0.02,
                                        field.unknown_likelihood, "share of beams that hit what no map knows"),
                             "z_rand"));
  keys.push_back(
      flag_key("localization.track.surfaces", localizer.follow_surfaces,
               "whether straight surfaces give the pose where they explain the scans; false: particles always do"));
  keys.push_back(flag_key("localization.temporary.weighing", localizer.temporary.weighing,
                          "leave beams that end at a transient obstacle out of the weights of the particles"));
}

/// The keys of global localization: when it may end, and how much of the map it looks at in one scan.
void add_belief(localization::LocalizerParams& localizer, Keys& keys) {
  keys.push_back(number_key("localization.global.converged_after_m", localizer.fit.converged_after_m, "m", 0.0, 1000.0,
                            "distance driven before global localization may end, unless the robot has turned by half "
                            "a turn: one view may look like another"));
  keys.push_back(whole_key("localization.global.candidates_a_scan", localizer.global.alone.candidates, "", 100,
                           100000000, "poses of the whole map looked at in one scan while the pose is unknown"));
}

}  // namespace

void add_localization_keys(localization::LocalizerParams& localizer, Keys& keys) {
  keys.push_back(whole_key("localization.beams", localizer.beams, "", 0, 1000,
                           "beams of a scan that are weighed, evenly chosen among the valid ones; 0: all"));
  keys.push_back(number_key("localization.kidnapping_prior", localizer.hypothesis_tracker.elsewhere_prior, "", 1e-30,
                            1.0,
                            "odds of any pose hypothesis elsewhere against the believed one, before any scan: how "
                            "rarely the robot is kidnapped"));
  add_particles(localizer, keys);
  add_wheels(localizer, keys);
  add_sensor(localizer, keys);
  add_belief(localizer, keys);
}

}  // namespace deltamap::daemon
