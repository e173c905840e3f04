// SPDX-License-Identifier: Apache-2.0
// The table of keys: mapping.
#include "daemon/settings/settings_keys.hpp"

namespace deltamap::daemon {
namespace {

void add_evidence(mapping::evidence::EvidencePhaseParams& evidence, double& longest_drawn_m, Keys& keys) {
  keys.push_back(number_key("mapping.persistence_s", evidence.passing.persistence_s, "s", 0.0, 86400.0,
                            "time that a small free-standing object, or what comes and goes, must last to become map"));
  const std::string at = "mapping.evidence.";
  keys.push_back(number_key(
      at + "face_persistence_s", evidence.face_persistence_s, "s", 0.0, 86400.0,
      "time that a change must last to become map, unless it is a small free-standing object or comes and goes"));
  keys.push_back(number_key(at + "small_m", evidence.passing.small_m, "m", 0.0, 100.0,
                            "widest free-standing object that counts as small; 0: none is"));
  // One key sets both ranges: a beam must not draw cells that it does not vote on.
  double& judged_m = evidence.beams.most_range_m;
  keys.push_back(of_both(
      number_key(at + "most_range_m", judged_m, "m", 0.1, 100.0, "range beyond which a beam neither votes nor draws"),
      judged_m, longest_drawn_m));
}

void add_paper(mapping::paper::DivergenceRatioParams& ratio, mapping::paper::DeltaPhaseParams& phase, Keys& keys) {
  keys.push_back(with_symbol(number_key("mapping.paper.alpha_slow", ratio.alpha_slow, "", 1e-6, 1.0,
                                        "long-term rate of the average weight, per scan"),
                             "α_slow, Eq. 2"));
  keys.push_back(with_symbol(number_key("mapping.paper.alpha_fast", ratio.alpha_fast, "", 1e-6, 1.0,
                                        "short-term rate of the average weight, per scan"),
                             "α_fast, Eq. 2"));
  keys.push_back(with_symbol(number_key("mapping.paper.least_n_eff_share", phase.least_n_eff_share, "", 0.0, 1.0,
                                        "N_eff / particles below which a scan is not kept"),
                             "N_eff, Eq. 5"));
}

void add_paper_update(mapping::paper::PaperUpdateParams& paper, Keys& keys) {
  const std::string as_published = "mapping.paper.update.";
  keys.push_back(with_symbol(number_key(as_published + "least_acceptance", paper.least_acceptance, "", 0.0, 1.0,
                                        "acceptance below which a merge is refused"),
                             "Eq. 11"));
  keys.push_back(flag_key(as_published + "refuse_implausible", paper.refuse_implausible,
                          "refuse a merge that contradicts the localizer's pose (not published)"));
}

void add_gate(mapping::gate::WriteGateParams& gate, Keys& keys) {
  keys.push_back(
      flag_key("mapping.gate.enabled", gate.enabled, "write to the map only while the pose is sure (method evidence)"));
  keys.push_back(number_key("mapping.gate.least_pose_right", gate.least_pose_right, "", 0.0, 1.0,
                            "P(pose right) below which nothing is written"));
}

}  // namespace

void add_mapping_keys(MappingSettings& settings, Keys& keys) {
  keys.push_back(flag_key("mapping.enabled", settings.enabled, "whether the map follows the world"));
  auto& store_scan = settings.store_scan;
  keys.push_back(choice_key("mapping.method", store_scan.method,
                            {{"paper", MappingMethod::kPaper}, {"evidence", MappingMethod::kEvidence}},
                            "how changes are found and merged; paper: as published, evidence: votes of beams"));
  add_evidence(store_scan.evidence, settings.update.evidence.longest_m, keys);
  add_gate(store_scan.gate, keys);
  add_paper(settings.divergence, store_scan.delta_phase, keys);
  add_paper_update(settings.update.paper, keys);
  keys.push_back(flag_key("mapping.things.assume_sides", settings.things.assumes_sides,
                          "take sides of a thing that nobody has seen to be there where those seen fix its rectangle"));
}

}  // namespace deltamap::daemon
