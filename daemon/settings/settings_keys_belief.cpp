// SPDX-License-Identifier: Apache-2.0
// The table of keys: what localization believes of a pose: its states, the other places, the verdict.
#include "daemon/settings/settings_keys.hpp"

namespace deltamap::daemon {
namespace {

void add_states(localization::LocalizerParams& localizer, Keys& keys) {
  auto& hypothesis = localizer.hypothesis;
  keys.push_back(number_key("localization.hypothesis.cell_m", hypothesis.cell_m, "m", 0.01, 10.0,
                            "particles in neighbouring cells of this side form one pose hypothesis"));
  keys.push_back(degrees_key("localization.hypothesis.heading_cell_deg", hypothesis.heading_cell_rad, 1.0, 90.0,
                             "height of a hypothesis cell in heading"));
  auto& fit = localizer.fit;
  keys.push_back(number_key("localization.fit.lost_below", fit.lost_below, "", 0.0, 1.0,
                            "mean share of explained beams below which the map misfits"));
  keys.push_back(number_key("localization.fit.found_above", fit.found_above, "", 0.0, 1.0,
                            "mean share of explained beams above which a lost pose is found again"));
  keys.push_back(number_key("localization.fit.lost_after_s", fit.lost_after_s, "s", 0.001, 3600.0,
                            "unbroken misfit until the pose is lost, where another place fits better"));
  keys.push_back(number_key("localization.fit.lost_nowhere_after_s", fit.lost_nowhere_after_s, "s", 0.001, 3600.0,
                            "unbroken misfit until the pose is lost, where no other place fits better"));
  keys.push_back(number_key("localization.fit.memory_s", fit.memory_s, "s", 0.001, 3600.0,
                            "time constant of the mean share of explained beams"));
  keys.push_back(number_key("localization.fit.search_after_s", fit.search_after_s, "s", 0.0, 86400.0,
                            "time lost until the whole map is searched; search_after_m must be driven too"));
  keys.push_back(number_key("localization.fit.search_after_m", fit.search_after_m, "m", 0.0, 1000.0,
                            "distance driven while lost until the whole map is searched"));
  keys.push_back(number_key("localization.fit.converged_share", fit.converged_share, "", 0.5, 1.0,
                            "weight of the best hypothesis from which global localization may end"));
  keys.push_back(
      number_key("localization.fit.converged_m", fit.converged_m, "m", 0.001, 10.0,
                 "standard deviation of the best hypothesis' position below which global localization may end"));
  keys.push_back(
      degrees_key("localization.fit.converged_deg", fit.converged_rad, 0.1, 180.0,
                  "standard deviation of the best hypothesis' heading below which global localization may end"));
  keys.push_back(
      number_key("localization.fit.converged_after_m", fit.converged_after_m, "m", 0.0, 1000.0,
                 "distance driven before global localization may end, unless converged_after_deg is turned first"));
  keys.push_back(
      degrees_key("localization.fit.converged_after_deg", fit.converged_after_rad, 0.0, 3600.0,
                  "angle turned before global localization may end, unless converged_after_m is driven first"));
  keys.push_back(number_key("localization.fit.lost_by_verdict_s", fit.lost_by_verdict_s, "s", 0.0, 3600.0,
                            "unbroken verdict \"wrong\" until the pose is lost"));
  keys.push_back(
      number_key("localization.fit.distrusted_after_s", fit.distrusted_after_s, "s", 0.001, 3600.0,
                 "time in which all beams speak against the pose until it is lost, though no proven tile is in view"));
  keys.push_back(number_key("localization.fit.distrust", fit.distrust, "", 0.0, 0.5,
                            "P(pose right) by all beams, proven or not, up to which they speak against the pose"));
  keys.push_back(number_key("localization.fit.suspicious_below", fit.suspicious_below, "", 0.0, 1.0,
                            "mean share of explained beams below which other places are searched too"));
  keys.push_back(number_key("localization.fit.converged_unfit_after_m", fit.converged_unfit_after_m, "m", 0.0, 1000.0,
                            "distance driven before global localization may end where the map explains little"));
}

void add_places(localization::LocalizerParams& localizer, Keys& keys) {
  auto& global = localizer.global;
  keys.push_back(whole_key("localization.global.candidates_a_scan", global.candidates_a_scan, "", 100, 100000000,
                           "poses of the whole map looked at in one scan while the pose is unknown"));
  keys.push_back(whole_key("localization.global.places", global.places, "", 1, 100000,
                           "best of the poses looked at that are refined to their best fit"));
  keys.push_back(whole_key("localization.global.places_a_scan", global.places_a_scan, "", 1, 100000,
                           "poses refined to their best fit in one scan"));
  keys.push_back(number_key("localization.global.again_after_m", global.again_after_m, "m", 0.01, 1000.0,
                            "distance driven until the whole map is looked at again"));
  keys.push_back(degrees_key("localization.global.again_after_deg", global.again_after_rad, 0.1, 3600.0,
                             "angle turned until the whole map is looked at again"));
  auto& places = localizer.places;
  keys.push_back(whole_key("localization.places.most", places.most, "", 1, 1000,
                           "pose hypotheses followed while the pose is unknown"));
  keys.push_back(whole_key("localization.places.most_while_believing", places.most_while_believing, "", 1, 1000,
                           "pose hypotheses followed beside a believed pose"));
  keys.push_back(whole_key("localization.places.beams", places.beams, "", 1, 1000,
                           "beams of a scan that judge a pose hypothesis"));
  keys.push_back(number_key(
      "localization.places.evidence_beams", places.evidence_beams, "", 0.1, 1000.0,
      "independent beams that as many as places.beams count as; fewer beams count less, and at most a quarter does"));
  keys.push_back(number_key("localization.places.step_m", places.step_m, "m", 0.001, 100.0,
                            "distance driven until a scan is new evidence on a pose hypothesis"));
  keys.push_back(degrees_key("localization.places.step_deg", places.step_rad, 0.1, 360.0,
                             "angle turned until a scan is new evidence on a pose hypothesis"));
  keys.push_back(number_key("localization.places.memory_steps", places.memory_steps, "", 1.001, 1e6,
                            "scans of new evidence until old evidence has faded to 1/e"));
  keys.push_back(number_key("localization.places.hopeless", places.hopeless, "", 0.1, 1000.0,
                            "log evidence behind the best hypothesis at which another is given up"));
  keys.push_back(number_key("localization.places.same_m", places.same_m, "m", 0.01, 10.0,
                            "two hypotheses nearer than this, and turned less than same_deg, are one"));
  keys.push_back(degrees_key("localization.places.same_deg", places.same_rad, 0.1, 180.0,
                             "two hypotheses turned less than this, and nearer than same_m, are one"));
  auto& rivals = localizer.rivals;
  keys.push_back(whole_key("localization.rivals.probes", rivals.probes, "", 0, 100000000,
                           "poses of the whole map looked at in one scan while tracking"));
  keys.push_back(whole_key("localization.rivals.probes_nearby", rivals.probes_nearby, "", 0, 1000000,
                           "poses around the believed one looked at in one scan while tracking"));
  keys.push_back(number_key("localization.rivals.nearby_m", rivals.nearby_m, "m", 0.01, 100.0,
                            "farthest distance of a probe around the believed pose"));
  keys.push_back(degrees_key("localization.rivals.nearby_deg", rivals.nearby_rad, 0.1, 180.0,
                             "largest turn of a probe around the believed pose"));
  keys.push_back(number_key("localization.rivals.nearby_prior", rivals.nearby_prior, "", 1e-30, 1.0,
                            "odds of a place nearby against the believed one, before any scan"));
  keys.push_back(number_key(
      "localization.rivals.elsewhere_prior", rivals.elsewhere_prior, "", 1e-30, 1.0,
      "odds of any other place against the believed one, before any scan: how rarely somebody carries the robot away"));
  keys.push_back(number_key("localization.rivals.carried_prior", rivals.carried_prior, "", 0.0, 1.0,
                            "odds that the robot has just been carried to a place that fits from then on"));
  keys.push_back(number_key("localization.rivals.held_by", rivals.held_by, "", 0.0, 1000.0,
                            "more log evidence that must speak against a pose that proven tiles hold"));
  keys.push_back(
      number_key("localization.rivals.prior_after_search", rivals.prior_after_search, "", 1e-30, 1.0,
                 "odds of any other place against the believed one, where that was found by a search and not given"));
  keys.push_back(number_key("localization.rivals.kidnapped_prior", rivals.kidnapped_prior, "", 1e-30, 1.0,
                            "odds of being elsewhere against being near, where the believed place has proven wrong"));
  keys.push_back(whole_key("localization.rivals.refined_a_scan", rivals.refined_a_scan, "", 0, 1000,
                           "other hypotheses refined to their best fit in one scan while tracking"));
  keys.push_back(number_key("localization.rivals.winning_share", rivals.winning_share, "", 0.5, 1.0,
                            "share of the belief at which another place is believed instead"));
  keys.push_back(number_key("localization.rivals.wins_after_m", rivals.wins_after_m, "m", 0.0, 1000.0,
                            "distance driven since another place was found before it may be believed"));
  keys.push_back(
      number_key("localization.rivals.beats_by", rivals.beats_by, "", 0.1, 1000.0,
                 "log evidence ahead from which another place fits clearly better, whatever the odds before"));
  keys.push_back(number_key("localization.rivals.equal_within", rivals.equal_within, "", 0.0, 1000.0,
                            "log evidence within which two places fit about as well"));
  keys.push_back(
      number_key("localization.rivals.block_m", rivals.block_m, "m", 0.01, 10.0,
                 "side of a block of the coarse field, and so the step between the positions that are searched"));
  keys.push_back(
      number_key("localization.rivals.most_ahead", rivals.most_ahead, "", 0.0, 1000.0,
                 "log evidence that a place may at most be ahead of the believed one with when it is found"));
  keys.push_back(
      number_key("localization.rivals.suspicious_pace", rivals.suspicious_pace, "", 0.001, 1.0,
                 "speed of a search of the whole map while a pose is believed, as a share of global localization's"));
  keys.push_back(whole_key("localization.rivals.images", rivals.images, "", 0, 1000,
                           "aliases of a place, where the map looks alike, that are remembered"));
  keys.push_back(whole_key("localization.rivals.images_a_scan", rivals.images_a_scan, "", 0, 1000,
                           "aliases looked at again in one scan while tracking"));
  keys.push_back(whole_key("localization.rivals.headings", rivals.headings, "", 1, 720,
                           "headings of each position that is searched"));
}

void add_beam_check(localization::belief::JudgementParams& judgement, Keys& keys) {
  keys.push_back(number_key("localization.beam_check.after_m", judgement.check_m, "m", 0.0, 10.0,
                            "distance driven until beams are held against the map again"));
  keys.push_back(degrees_key("localization.beam_check.after_deg", judgement.check_rad, 0.0, 180.0,
                             "angle turned until beams are held against the map again"));
  keys.push_back(number_key("localization.beam_check.after_s", judgement.check_s, "s", 0.0, 3600.0,
                            "time passed until beams are held against the map again"));
  auto& beams = judgement.beams;
  keys.push_back(number_key("localization.beam_check.deviations", beams.deviations, "", 0.1, 10.0,
                            "half width of the interval in which a range still fits, in standard deviations"));
  keys.push_back(number_key("localization.beam_check.hit_deviation_m", beams.hit_deviation_m, "m", 0.001, 2.0,
                            "standard deviation of a range, laser and map together; at least one cell is used"));
  keys.push_back(number_key("localization.beam_check.least_position_deviation_m", beams.least_position_deviation_m, "m",
                            0.0, 10.0, "standard deviation added to the estimated one of the position"));
  keys.push_back(degrees_key("localization.beam_check.least_heading_deviation_deg", beams.least_heading_deviation_rad,
                             0.0, 90.0, "standard deviation added to the estimated one of the heading"));
  keys.push_back(number_key("localization.beam_check.most_aside_m", beams.most_aside_m, "m", 0.01, 10.0,
                            "standard deviation across a beam beyond which the beam says nothing"));
  keys.push_back(number_key("localization.beam_check.beyond_m", beams.beyond_m, "m", 0.0, 10.0,
                            "distance by which a beam must end behind what it went through"));
}

void add_verdict(localization::LocalizerParams& localizer, Keys& keys) {
  auto& stability = localizer.judgement.stability;
  keys.push_back(number_key("localization.stability.apart_s", stability.apart_s, "s", 0.1, 86400.0,
                            "shortest time between two confirmations of a tile that count"));
  keys.push_back(number_key("localization.stability.apart_m", stability.apart_m, "m", 0.1, 100.0,
                            "shortest distance between the places from which a tile is confirmed"));
  keys.push_back(whole_key("localization.stability.proven_after", stability.proven_after, "", 1, 60,
                           "confirmations that prove a tile to stay"));
  keys.push_back(number_key("localization.stability.tile_m", stability.tile_m, "m", 0.01, 10.0, "side of a tile"));
  auto& judgement = localizer.judgement;
  keys.push_back(number_key("localization.stability.earn_right_above", judgement.earn_right_above, "", 0.5, 1.0,
                            "P(pose right) above which tiles are confirmed"));
  keys.push_back(number_key("localization.stability.earn_deviation_m", judgement.earn_deviation_m, "m", 0.001, 10.0,
                            "standard deviation of the position below which tiles are confirmed"));
  add_beam_check(judgement, keys);
  auto& verdict = localizer.judgement.verdict;
  keys.push_back(whole_key("localization.verdict.beams", localizer.judgement.beams.beams, "", 8, 1000,
                           "beams of a scan that are held against what the map expects"));
  keys.push_back(number_key("localization.verdict.right_above", verdict.right_above, "", 0.5, 1.0,
                            "P(pose right) from which the verdict is \"right\""));
  keys.push_back(number_key(
      "localization.verdict.wrong_below", verdict.wrong_below, "", 0.0, 0.5,
      "P(pose right) up to which the verdict is \"wrong\"; between wrong_below and right_above it is \"undecided\""));
  keys.push_back(number_key("localization.verdict.unproven_limit", verdict.unproven_limit, "", 0.5, 1.0,
                            "P(pose right) at most where nothing in view has proven to stay"));
  keys.push_back(number_key("localization.verdict.lost_in_a_view", verdict.lost_in_a_view, "", 0.0, 0.1,
                            "probability that the pose has become wrong from one new view to the next"));
  keys.push_back(number_key("localization.verdict.least_wrong", verdict.least_wrong, "", 0.0, 0.1,
                            "P(pose wrong) that no evidence undercuts"));
  keys.push_back(number_key("localization.verdict.view_m", verdict.view_m, "m", 0.01, 100.0,
                            "distance driven until a view is new"));
  keys.push_back(
      degrees_key("localization.verdict.view_deg", verdict.view_rad, 0.1, 360.0, "angle turned until a view is new"));
  keys.push_back(
      number_key("localization.verdict.view_s", verdict.view_s, "s", 0.01, 3600.0, "time passed until a view is new"));
  keys.push_back(
      number_key("localization.verdict.short_weight", verdict.short_weight, "", 0.0, 1.0,
                 "weight of a beam that something stands in front of, against one that goes through a wall"));
  keys.push_back(number_key("localization.verdict.unproven_weight", verdict.unproven_weight, "", 0.0, 1.0,
                            "weight of a beam on a tile that has not proven to stay, against one on a proven tile"));
  keys.push_back(number_key("localization.verdict.least_beams", verdict.least_beams, "", 0.1, 1000.0,
                            "beams that must tell of a direction before it counts"));
  keys.push_back(number_key("localization.verdict.doubt_after_search", verdict.doubt_after_search, "", 0.0, 10.0,
                            "log odds taken from what a view says, for a place that was found by its fit"));
  keys.push_back(number_key("localization.verdict.views_after_search", verdict.views_after_search, "", 0.0, 1000.0,
                            "new views before a place that was found by its fit is called right"));
  keys.push_back(number_key("localization.verdict.views_of_suspicion", verdict.views_of_suspicion, "", 0.0, 1000.0,
                            "new views before a pose is called right whose hold has fallen from one scan to the next"));
  keys.push_back(number_key("localization.verdict.unique_for_views", verdict.unique_for_views, "", 0.0, 1000.0,
                            "views without another place that fits about as well before a pose is called right"));
  keys.push_back(number_key("localization.verdict.proof_memory_views", verdict.proof_memory_views, "", 0.1, 1e6,
                            "views for which it still counts that proven tiles held the pose"));
  keys.push_back(number_key("localization.verdict.changed_above", verdict.changed_above, "", 0.0, 1.0,
                            "share of beams off the map from which the map is called wrong here rather than right"));
}

}  // namespace

void add_belief_keys(localization::LocalizerParams& localizer, Keys& keys) {
  add_states(localizer, keys);
  add_places(localizer, keys);
  add_verdict(localizer, keys);
}

}  // namespace deltamap::daemon
