// SPDX-License-Identifier: Apache-2.0
// The table of keys: mapping.
#include "daemon/settings_keys.hpp"

namespace deltamap::daemon {
namespace {

/// One range for both: what a beam says nothing about it must not draw.
SettingKey most_range_key(std::string name, double& judged_m, double& drawn_m) {
  SettingKey key =
      number_key(std::move(name), judged_m, "m", 0.1, 100.0, "beyond, a beam neither says nor draws anything");
  key.assign = [assign = std::move(key.assign), &judged_m, &drawn_m](const SettingValue& value) {
    const auto needed = assign(value);
    drawn_m = judged_m;
    return needed;
  };
  return key;
}

void add_evidence(mapping::awareness::EvidencePhaseParams& evidence, double& longest_drawn_m, Keys& keys) {
  keys.push_back(number_key("mapping.persistence_s", evidence.passing.persistence_s, "s", 0.0, 86400.0,
                            "how long a small free-standing thing, or what toggles, must last to become map"));
  const std::string at = "mapping.evidence.";
  keys.push_back(number_key(at + "face_persistence_s", evidence.face_persistence_s, "s", 0.0, 86400.0,
                            "how long any other difference must last"));
  keys.push_back(
      number_key(at + "small_m", evidence.passing.small_m, "m", 0.0, 100.0, "what is wider is no small thing"));
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
  keys.push_back(most_range_key(at + "most_range_m", evidence.beams.most_range_m, longest_drawn_m));
  keys.push_back(
      number_key(at + "range_deviation_m", evidence.beams.range_deviation_m, "m", 0.001, 1.0, "of the laser"));
  keys.push_back(number_key(at + "forget_s", evidence.votes.forget_s, "s", 1.0, 86400.0,
                            "without votes until a block starts anew"));
}

void add_temporary(mapping::awareness::TemporaryParams& temporary, Keys& keys) {
  const std::string at = "mapping.temporary.";
  keys.push_back(whole_key(at + "least_votes", temporary.least_votes, "", 1, 255,
                           "keyframes that put a block into the temporary layer (method evidence)"));
  keys.push_back(whole_key(at + "most_votes", temporary.most_votes, "", 1, 255,
                           "keyframes that must see otherwise, at most, until it leaves; at least least_votes"));
  keys.push_back(number_key(at + "lapse_s", temporary.lapse_s, "s", 1.0, 86400.0, "unseen, until it leaves"));
  keys.push_back(whole_key(at + "most_blocks", temporary.most_blocks, "", 1, 1000000, "of each kind; 32 bytes each"));
}

void add_evidence_update(mapping::EvidenceUpdateParams& evidence, Keys& keys) {
  const std::string with_evidence = "mapping.evidence.update.";
  keys.push_back(
      whole_key(with_evidence + "least_scans", evidence.least_scans, "", 1, 1000, "fewer that fit are refused"));
  keys.push_back(number_key(with_evidence + "most_implausible_share", evidence.most_implausible_share, "", 0.0, 1.0,
                            "of the scans that contradict the localizer"));
  keys.push_back(number_key(with_evidence + "occupied_hit_share", evidence.occupied_hit_share, "", 0.0, 1.0,
                            "hits among the beams in a cell that make it occupied"));
  keys.push_back(number_key(with_evidence + "free_hit_share", evidence.free_hit_share, "", 0.0, 1.0,
                            "hits among the beams in a cell that still leave it free"));
  keys.push_back(whole_key(with_evidence + "least_speck_cells", evidence.least_speck_cells, "", 1, 10000,
                           "smaller groups of new occupied cells are left out"));
  keys.push_back(number_key(with_evidence + "least_acceptance", evidence.least_acceptance, "", 0.0, 1.0,
                            "acceptance (Eq. 11) below which an update is refused"));
}

void add_paper(mapping::StoreScanParams& store_scan, Keys& keys) {
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

void add_paper_update(mapping::PaperUpdateParams& paper, Keys& keys) {
  const std::string as_published = "mapping.paper.update.";
  keys.push_back(whole_key(as_published + "least_scans", paper.least_scans, "", 2, 1000, "fewer draw no map"));
  keys.push_back(number_key(as_published + "least_acceptance", paper.least_acceptance, "", 0.0, 1.0,
                            "acceptance (Eq. 11) below which a merge is refused"));
  keys.push_back(flag_key(as_published + "refuse_implausible", paper.refuse_implausible,
                          "refuse a merge that contradicts the localizer's pose (not published)"));
  keys.push_back(number_key(as_published + "most_chi2", paper.most_chi2, "", 0.0, 1000.0, "where it contradicts"));
}

void add_gate(mapping::WriteGateParams& gate, Keys& keys) {
  const std::string at = "mapping.gate.";
  keys.push_back(flag_key(at + "enabled", gate.enabled, "write only while the pose is sure (method evidence)"));
  keys.push_back(number_key(at + "least_pose_right", gate.least_pose_right, "", 0.0, 1.0,
                            "P(pose right) below which nothing is written"));
  keys.push_back(number_key(at + "disbelieved_below", gate.disbelieved_below, "", 0.0, 1.0,
                            "P(pose right) below which the pose counts as proven wrong"));
  keys.push_back(number_key(at + "most_rival_share", gate.most_rival_share, "", 0.0, 1.0,
                            "of the belief, that another place may hold"));
  keys.push_back(
      number_key(at + "most_deviation_m", gate.most_deviation_m, "m", 0.01, 10.0, "of the position, worst axis"));
  keys.push_back(number_key(at + "jump_m", gate.jump.least_m, "m", 0.01, 10.0,
                            "off odometry within 3 s, besides the deviations, that proves a pose wrong"));
  keys.push_back(
      number_key(at + "confirm_s", gate.confirm_s, "s", 0.0, 3600.0, "so long the pose must hold after it was wrong"));
  keys.push_back(number_key(at + "confirm_m", gate.confirm_m, "m", 0.0, 1000.0, "and must have driven meanwhile"));
  keys.push_back(
      number_key(at + "most_misfit", gate.misfit.most_drop, "", 0.0, 1.0, "of the beams, that suddenly stop fitting"));
  keys.push_back(number_key(at + "most_break", gate.scan_break.most, "", 0.0, 1.0,
                            "of the beams, that break with the scan before: the robot was carried"));
  keys.push_back(number_key(at + "most_break_one_way", gate.scan_break.most_one_way, "", 0.0, 1.0,
                            "likewise where all are nearer, or all farther away"));
  keys.push_back(number_key(at + "wary_break", gate.wary_break, "", 0.0, 1.0,
                            "of the beams, that break: a worse fit soon after says that the robot was carried, …"));
  keys.push_back(number_key(at + "wary_s", gate.wary_s, "s", 0.0, 60.0, "… so soon"));
  keys.push_back(number_key(at + "most_doubt_s", gate.most_doubt_s, "s", 0.1, 3600.0,
                            "of doubt without a proof, until what is provisional is withdrawn"));
  keys.push_back(number_key(at + "hold_s", gate.hold_s, "s", 0.0, 60.0,
                            "a finished set waits so long for a sign that the pose was wrong"));
  keys.push_back(number_key(at + "hold_rival_share", gate.hold_rival_share, "", 0.0, 1.0,
                            "of the belief: while another place holds more, it waits on"));
  keys.push_back(number_key(at + "provisional_m", gate.provisional.way_m, "m", 0.0, 1000.0,
                            "the robot must have driven until what was written is settled, …"));
  keys.push_back(number_key(at + "provisional_s", gate.provisional.time_s, "s", 0.0, 3600.0,
                            "… and so much time have passed; until then it is withdrawn where the pose proves wrong"));
}

}  // namespace

void add_mapping_keys(MappingSettings& settings, Keys& keys) {
  keys.push_back(flag_key("mapping.enabled", settings.enabled, "let the map follow the world"));
  auto& store_scan = settings.store_scan;
  keys.push_back(choice_key("mapping.method", store_scan.method,
                            {{"paper", MappingMethod::kPaper}, {"evidence", MappingMethod::kEvidence}},
                            "how changes are found and merged"));
  add_evidence(store_scan.evidence, settings.update.evidence.longest_m, keys);
  add_evidence_update(settings.update.evidence, keys);
  add_temporary(store_scan.evidence.temporary, keys);
  add_gate(store_scan.gate, keys);
  add_paper(store_scan, keys);
  add_paper_update(settings.update.paper, keys);
}

}  // namespace deltamap::daemon
