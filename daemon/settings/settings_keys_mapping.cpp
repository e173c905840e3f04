// SPDX-License-Identifier: Apache-2.0
// The table of keys: mapping.
#include "daemon/settings/settings_keys.hpp"

namespace deltamap::daemon {
namespace {

/// One range for both: what a beam says nothing about it must not draw.
SettingKey most_range_key(std::string name, double& judged_m, double& drawn_m) {
  SettingKey key = number_key(std::move(name), judged_m, "m", 0.1, 100.0,
                              "range beyond which a beam neither says nor draws anything");
  key.assign = [assign = std::move(key.assign), &judged_m, &drawn_m](const SettingValue& value) {
    const auto needed = assign(value);
    drawn_m = judged_m;
    return needed;
  };
  return key;
}

void add_evidence(mapping::evidence::EvidencePhaseParams& evidence, double& longest_drawn_m, Keys& keys) {
  keys.push_back(number_key("mapping.persistence_s", evidence.passing.persistence_s, "s", 0.0, 86400.0,
                            "time that a small free-standing object, or what comes and goes, must last to become map"));
  const std::string at = "mapping.evidence.";
  keys.push_back(number_key(at + "face_persistence_s", evidence.face_persistence_s, "s", 0.0, 86400.0,
                            "time that any other difference must last to become map"));
  keys.push_back(number_key(at + "small_m", evidence.passing.small_m, "m", 0.0, 100.0,
                            "a free-standing object that is wider is not small"));
  keys.push_back(
      number_key(at + "least_votes", evidence.least_votes, "", 0.1, 1000.0, "keyframes that must see a change"));
  keys.push_back(number_key(at + "least_added_share", evidence.least_added_share, "", 0.5, 1.0,
                            "share of the votes on a block that must say \"added\""));
  keys.push_back(number_key(at + "least_removed_share", evidence.least_removed_share, "", 0.5, 1.0,
                            "share of the votes on a block that must say \"removed\""));
  keys.push_back(whole_key(at + "least_blocks", evidence.least_blocks, "", 1, 10000,
                           "blocks of a region at least; a smaller one is a speck and waits"));
  keys.push_back(number_key(at + "settle_s", evidence.settle_s, "s", 0.0, 3600.0,
                            "a region is handed on when it has not grown for this time"));
  keys.push_back(number_key(at + "most_wait_s", evidence.most_wait_s, "s", 0.0, 3600.0,
                            "a region is handed on after this time, though it still grows"));
  keys.push_back(most_range_key(at + "most_range_m", evidence.beams.most_range_m, longest_drawn_m));
  keys.push_back(number_key(at + "range_deviation_m", evidence.beams.range_deviation_m, "m", 0.001, 1.0,
                            "standard deviation of the laser's ranges"));
  keys.push_back(number_key(at + "forget_s", evidence.votes.forget_s, "s", 1.0, 86400.0,
                            "time without votes after which a block starts anew"));
}

void add_temporary(mapping::evidence::TransientLayerParams& temporary, Keys& keys) {
  const std::string at = "mapping.temporary.";
  keys.push_back(whole_key(at + "least_votes", temporary.least_votes, "", 1, 255,
                           "keyframes that put a block into the temporary layer (method evidence)"));
  keys.push_back(whole_key(
      at + "most_votes", temporary.most_votes, "", 1, 255,
      "keyframes at most that must see otherwise until a block leaves the temporary layer; at least least_votes"));
  keys.push_back(number_key(at + "lapse_s", temporary.lapse_s, "s", 1.0, 86400.0,
                            "time unseen after which a block leaves the temporary layer"));
  keys.push_back(whole_key(at + "most_blocks", temporary.most_blocks, "", 1, 1000000,
                           "blocks of each kind in the temporary layer; 32 bytes each"));
}

void add_evidence_update(mapping::redraw::EvidenceUpdateParams& evidence, Keys& keys) {
  const std::string with_evidence = "mapping.evidence.update.";
  keys.push_back(whole_key(with_evidence + "least_scans", evidence.least_scans, "", 1, 1000,
                           "scans that must fit; an update from fewer is refused"));
  keys.push_back(number_key(with_evidence + "most_implausible_share", evidence.most_implausible_share, "", 0.0, 1.0,
                            "share of the scans that may contradict the localizer; an update with more is refused"));
  keys.push_back(number_key(with_evidence + "occupied_hit_share", evidence.occupied_hit_share, "", 0.0, 1.0,
                            "share of hits among the beams in a cell from which it becomes occupied"));
  keys.push_back(number_key(with_evidence + "free_hit_share", evidence.free_hit_share, "", 0.0, 1.0,
                            "share of hits among the beams in a cell up to which it becomes free"));
  keys.push_back(whole_key(with_evidence + "least_speck_cells", evidence.least_speck_cells, "", 1, 10000,
                           "new occupied cells in a group; a smaller group is left out"));
  keys.push_back(with_symbol(number_key(with_evidence + "least_acceptance", evidence.least_acceptance, "", 0.0, 1.0,
                                        "acceptance below which an update is refused"),
                             "Eq. 11"));
}

void add_paper(mapping::StoreScanParams& store_scan, Keys& keys) {
  auto& ratio = store_scan.divergence;
  keys.push_back(with_symbol(number_key("mapping.paper.alpha_slow", ratio.alpha_slow, "", 1e-6, 1.0,
                                        "long-term rate of the average weight, per scan"),
                             "α_slow, Eq. 2"));
  keys.push_back(with_symbol(number_key("mapping.paper.alpha_fast", ratio.alpha_fast, "", 1e-6, 1.0,
                                        "short-term rate of the average weight, per scan"),
                             "α_fast, Eq. 2"));
  auto& phase = store_scan.delta_phase;
  keys.push_back(with_symbol(number_key("mapping.paper.least_n_eff_share", phase.least_n_eff_share, "", 0.0, 1.0,
                                        "N_eff / particles below which a scan is not kept"),
                             "N_eff, Eq. 5"));
  keys.push_back(with_symbol(
      whole_key("mapping.paper.most_scans", phase.most_scans, "", 2, 100000, "scans kept in one Δ-phase"), "S_k"));
}

void add_paper_update(mapping::paper::PaperUpdateParams& paper, Keys& keys) {
  const std::string as_published = "mapping.paper.update.";
  keys.push_back(whole_key(as_published + "least_scans", paper.least_scans, "", 2, 1000,
                           "scans that draw a local map; fewer draw none"));
  keys.push_back(with_symbol(number_key(as_published + "least_acceptance", paper.least_acceptance, "", 0.0, 1.0,
                                        "acceptance below which a merge is refused"),
                             "Eq. 11"));
  keys.push_back(flag_key(as_published + "refuse_implausible", paper.refuse_implausible,
                          "refuse a merge that contradicts the localizer's pose (not published)"));
  keys.push_back(
      number_key(as_published + "most_chi2", paper.most_chi2, "", 0.0, 1000.0,
                 "chi-square of three degrees of freedom above which a merge contradicts the localizer's pose"));
}

void add_gate(mapping::gate::WriteGateParams& gate, Keys& keys) {
  const std::string at = "mapping.gate.";
  keys.push_back(
      flag_key(at + "enabled", gate.enabled, "write to the map only while the pose is sure (method evidence)"));
  keys.push_back(number_key(at + "least_pose_right", gate.least_pose_right, "", 0.0, 1.0,
                            "P(pose right) below which nothing is written"));
  keys.push_back(number_key(at + "disbelieved_below", gate.disbelieved_below, "", 0.0, 1.0,
                            "P(pose right) below which the pose counts as proven wrong"));
  keys.push_back(number_key(at + "most_rival_share", gate.most_rival_share, "", 0.0, 1.0,
                            "share of the belief that another place may hold while the map is written"));
  keys.push_back(number_key(at + "most_deviation_m", gate.most_deviation_m, "m", 0.01, 10.0,
                            "standard deviation of the position, worst axis, up to which the map is written"));
  keys.push_back(number_key(at + "jump_m", gate.jump.least_m, "m", 0.01, 10.0,
                            "jump off odometry within 3 s, besides the standard deviations, that proves a pose wrong"));
  keys.push_back(number_key(at + "confirm_s", gate.confirm_s, "s", 0.0, 3600.0,
                            "time that a pose must hold after it was wrong; confirm_m must be driven too"));
  keys.push_back(number_key(at + "confirm_m", gate.confirm_m, "m", 0.0, 1000.0,
                            "distance that must be driven after a pose was wrong; confirm_s must pass too"));
  keys.push_back(number_key(at + "most_misfit", gate.misfit.most_drop, "", 0.0, 1.0,
                            "share of the beams that may suddenly stop fitting"));
  keys.push_back(number_key(at + "most_break", gate.scan_break.most, "", 0.0, 1.0,
                            "share of the beams that may break with the scan before; more: the robot was carried"));
  keys.push_back(
      number_key(at + "most_break_one_way", gate.scan_break.most_one_way, "", 0.0, 1.0,
                 "share of the beams that may break with the scan before where all are nearer, or all farther away"));
  keys.push_back(number_key(at + "wary_break", gate.wary_break, "", 0.0, 1.0,
                            "share of the beams that break with the scan before from which a worse fit within wary_s "
                            "says that the robot was carried"));
  keys.push_back(number_key(at + "wary_s", gate.wary_s, "s", 0.0, 60.0,
                            "time for which a worse fit counts after a break of wary_break"));
  keys.push_back(number_key(at + "most_doubt_s", gate.most_doubt_s, "s", 0.1, 3600.0,
                            "doubt without a proof until what is provisional is withdrawn"));
  keys.push_back(number_key(at + "hold_s", gate.hold_s, "s", 0.0, 60.0,
                            "time that a finished set waits for a sign that the pose was wrong"));
  keys.push_back(number_key(at + "hold_rival_share", gate.hold_rival_share, "", 0.0, 1.0,
                            "share of the belief: while another place holds more, a finished set goes on waiting"));
  keys.push_back(number_key(
      at + "provisional_m", gate.provisional.way_m, "m", 0.0, 1000.0,
      "distance driven until what was written is settled; before, it is withdrawn where the pose proves wrong"));
  keys.push_back(
      number_key(at + "provisional_s", gate.provisional.time_s, "s", 0.0, 3600.0,
                 "time passed until what was written is settled; before, it is withdrawn where the pose proves wrong"));
}

}  // namespace

void add_mapping_keys(MappingSettings& settings, Keys& keys) {
  keys.push_back(flag_key("mapping.enabled", settings.enabled, "whether the map follows the world"));
  auto& store_scan = settings.store_scan;
  keys.push_back(choice_key("mapping.method", store_scan.method,
                            {{"paper", MappingMethod::kPaper}, {"evidence", MappingMethod::kEvidence}},
                            "how changes are found and merged; paper: as published, evidence: votes of beams"));
  add_evidence(store_scan.evidence, settings.update.evidence.longest_m, keys);
  add_evidence_update(settings.update.evidence, keys);
  add_temporary(store_scan.evidence.temporary, keys);
  add_gate(store_scan.gate, keys);
  add_paper(store_scan, keys);
  add_paper_update(settings.update.paper, keys);
}

}  // namespace deltamap::daemon
