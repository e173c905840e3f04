// SPDX-License-Identifier: Apache-2.0
// The table of keys: localization.
#include "daemon/settings_keys.hpp"

namespace deltamap::daemon {
namespace {

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
  keys.push_back(number_key("localization.gap_s", localizer.gap_s, "s", 0.1, 1e9,
                            "without a scan, after which the pose must prove itself again"));
  auto& update = localizer.update;
  keys.push_back(number_key("localization.update.distance_m", update.distance_m, "m", 0.0, 10.0,
                            "driven until a scan is weighed again"));
  keys.push_back(
      degrees_key("localization.update.turn_deg", update.turn_rad, 0.0, 180.0, "turned until a scan is weighed again"));
  keys.push_back(number_key("localization.update.time_s", update.time_s, "s", 0.001, 3600.0,
                            "passed until a scan is weighed again"));
}

void add_beam_model(localization::LocalizerParams& localizer, Keys& keys) {
  using localization::ScanModel;
  keys.push_back(choice_key("localization.model", localizer.model,
                            {{"likelihood_field", ScanModel::kLikelihoodField}, {"beam", ScanModel::kBeam}},
                            "what weighs the particles; beam: for comparison, a hundred times as dear"));
  auto& beam = localizer.beam_model;
  keys.push_back(number_key("localization.beam_model.hit_deviation_m", beam.hit_deviation_m, "m", 0.001, 2.0,
                            "of laser and map together (sigma_hit)"));
  keys.push_back(number_key("localization.beam_model.short_share", beam.short_share, "", 0.0, 0.3,
                            "of beams that something unmapped stops (z_short)"));
  keys.push_back(number_key("localization.beam_model.short_per_m", beam.short_per_m, "1/m", 0.001, 10.0,
                            "how thick it stands (lambda_short)"));
  keys.push_back(number_key("localization.beam_model.max_share", beam.max_share, "", 0.0, 0.3,
                            "of beams that bring nothing back (z_max)"));
  keys.push_back(number_key("localization.beam_model.random_share", beam.random_share, "", 0.001, 0.3,
                            "of beams that nothing explains (z_rand)"));
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
  add_beam_model(localizer, keys);
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
  keys.push_back(number_key("localization.fit.lost_after_s", fit.lost_after_s, "s", 0.001, 3600.0,
                            "unbroken misfit, another place fitting better, until lost"));
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
  keys.push_back(number_key("localization.fit.lost_by_verdict_s", fit.lost_by_verdict_s, "s", 0.0, 3600.0,
                            "unbroken verdict wrong until lost"));
  keys.push_back(number_key("localization.fit.distrusted_after_s", fit.distrusted_after_s, "s", 0.001, 3600.0,
                            "likewise all beams against the pose, though nothing proven is in view"));
  keys.push_back(number_key("localization.fit.search_fails_after_s", fit.search_fails_after_s, "s", 0.001, 3600.0,
                            "unbroken misfit of what a search leads with until it begins anew"));
}

void add_places(localization::LocalizerParams& localizer, Keys& keys) {
  auto& global = localizer.global;
  keys.push_back(whole_key("localization.global.candidates_a_scan", global.candidates_a_scan, "", 100, 100000000,
                           "poses of the whole map that are looked at in one scan while the pose is unknown"));
  keys.push_back(
      whole_key("localization.global.places", global.places, "", 1, 100000, "of these, slid to their best fit"));
  keys.push_back(
      whole_key("localization.global.places_a_scan", global.places_a_scan, "", 1, 100000, "of these, in one scan"));
  keys.push_back(number_key("localization.global.again_after_m", global.again_after_m, "m", 0.01, 1000.0,
                            "driven until the whole map is looked at again"));
  keys.push_back(degrees_key("localization.global.again_after_deg", global.again_after_rad, 0.1, 3600.0, "or turned"));
  auto& places = localizer.places;
  keys.push_back(
      whole_key("localization.places.most", places.most, "", 1, 1000, "places followed while the pose is unknown"));
  keys.push_back(whole_key("localization.places.most_while_believing", places.most_while_believing, "", 1, 1000,
                           "and beside a believed pose"));
  keys.push_back(whole_key("localization.places.beams", places.beams, "", 1, 1000, "of a scan that judge a place"));
  keys.push_back(number_key("localization.places.evidence_beams", places.evidence_beams, "", 0.1, 1000.0,
                            "independent beams that a scan counts as between places"));
  keys.push_back(number_key("localization.places.step_m", places.step_m, "m", 0.001, 100.0,
                            "driven until a scan tells something new"));
  keys.push_back(degrees_key("localization.places.step_deg", places.step_rad, 0.1, 360.0, "or turned"));
  keys.push_back(number_key("localization.places.memory_steps", places.memory_steps, "", 1.001, 1e6,
                            "such scans until their evidence has faded to 1/e"));
  keys.push_back(number_key("localization.places.hopeless", places.hopeless, "", 0.1, 1000.0,
                            "log evidence behind the best at which a place is given up"));
  auto& rivals = localizer.rivals;
  keys.push_back(whole_key("localization.rivals.probes", rivals.probes, "", 0, 100000000,
                           "poses of the whole map that are looked at in one scan while tracking"));
  keys.push_back(whole_key("localization.rivals.probes_nearby", rivals.probes_nearby, "", 0, 1000000,
                           "and around the believed pose"));
  keys.push_back(number_key("localization.rivals.nearby_m", rivals.nearby_m, "m", 0.01, 100.0, "how far around"));
  keys.push_back(degrees_key("localization.rivals.nearby_deg", rivals.nearby_rad, 0.1, 180.0, "likewise"));
  keys.push_back(number_key("localization.rivals.nearby_prior", rivals.nearby_prior, "", 1e-30, 1.0,
                            "odds of a place nearby against the believed one, before any scan"));
  keys.push_back(number_key("localization.rivals.elsewhere_prior", rivals.elsewhere_prior, "", 1e-30, 1.0,
                            "odds of any other place: how rarely somebody carries the robot away"));
  keys.push_back(whole_key("localization.rivals.refined_a_scan", rivals.refined_a_scan, "", 0, 1000,
                           "places slid to their best fit at a scan"));
  keys.push_back(number_key("localization.rivals.winning_share", rivals.winning_share, "", 0.5, 1.0,
                            "of the belief at which another place is believed instead"));
  keys.push_back(number_key("localization.rivals.wins_after_m", rivals.wins_after_m, "m", 0.0, 1000.0,
                            "driven since it was found before another place may win"));
  keys.push_back(number_key("localization.rivals.block_m", rivals.block_m, "m", 0.01, 10.0,
                            "lattice of poses: between two positions"));
  keys.push_back(whole_key("localization.rivals.headings", rivals.headings, "", 1, 720, "and headings"));
}

void add_verdict(localization::LocalizerParams& localizer, Keys& keys) {
  auto& stability = localizer.judgement.stability;
  keys.push_back(number_key("localization.stability.apart_s", stability.apart_s, "s", 0.1, 86400.0,
                            "between two confirmations of a tile that count"));
  keys.push_back(number_key("localization.stability.apart_m", stability.apart_m, "m", 0.1, 100.0,
                            "between the places that they are made from"));
  keys.push_back(whole_key("localization.stability.proven_after", stability.proven_after, "", 1, 60,
                           "confirmations until a tile has proven to stay"));
  auto& verdict = localizer.judgement.verdict;
  keys.push_back(whole_key("localization.verdict.beams", localizer.judgement.beams.beams, "", 8, 1000,
                           "beams that are held against what the map expects"));
  keys.push_back(number_key("localization.verdict.right_above", verdict.right_above, "", 0.5, 1.0,
                            "P(pose right) from which the verdict is right"));
  keys.push_back(number_key("localization.verdict.wrong_below", verdict.wrong_below, "", 0.0, 0.5,
                            "P(pose right) up to which it is wrong; between: undecided"));
  keys.push_back(number_key("localization.verdict.unproven_limit", verdict.unproven_limit, "", 0.5, 1.0,
                            "P(pose right) at most where nothing in view has proven to stay"));
  keys.push_back(number_key("localization.verdict.lost_in_a_view", verdict.lost_in_a_view, "", 0.0, 0.1,
                            "P(the pose has become wrong) from one new view to the next"));
  keys.push_back(number_key("localization.verdict.changed_above", verdict.changed_above, "", 0.0, 1.0,
                            "share of beams off the map from which the map is rather wrong here"));
}

}  // namespace

void add_localization_keys(localization::LocalizerParams& localizer, Keys& keys) {
  add_particles(localizer, keys);
  add_models(localizer, keys);
  add_states(localizer, keys);
  add_places(localizer, keys);
  add_verdict(localizer, keys);
}

}  // namespace deltamap::daemon
