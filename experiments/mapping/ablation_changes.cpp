// SPDX-License-Identifier: Apache-2.0
#include "experiments/mapping/ablation_changes.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <string_view>
#include <utility>

#include "experiments/scan_table.hpp"

namespace deltamap::experiments {
namespace {

using daemon::SettingKey;
using daemon::Settings;

constexpr double kNever = 1e9;

struct Mechanism {
  std::string_view name;
  std::string_view what;
  void (*switch_off)(Settings&);
};

constexpr std::array kOfLocalization{
    Mechanism{"refinement", "refinement of the pose", [](Settings& s) { s.localizer.refinement.steps = 0; }},
    Mechanism{"refinement-prior", "the particles' covariance in the refinement",
              [](Settings& s) { s.localizer.refinement.prior_share = 0.0; }},
    Mechanism{"learned-wheels", "noise of the wheels learned while driving",
              [](Settings& s) { s.localizer.wheels.learning_share = 0.0; }},
    Mechanism{"slips", "particles that slip", [](Settings& s) { s.localizer.motion.slip_probability = 0.0; }},
    Mechanism{"probes", "probes of the whole map while tracking",
              [](Settings& s) { s.localizer.hypothesis_tracker.probes = 0; }},
    Mechanism{"probes-nearby", "probes around the believed pose",
              [](Settings& s) { s.localizer.hypothesis_tracker.probes_nearby = 0; }},
    Mechanism{"refined-hypotheses", "refinement of other pose hypotheses while tracking",
              [](Settings& s) { s.localizer.hypothesis_tracker.refined_a_scan = 0; }},
    Mechanism{"support", "support of the believed pose by proven tiles",
              [](Settings& s) { s.localizer.hypothesis_tracker.stable_support_nats = 0.0; }},
    Mechanism{"kidnapped-share", "write gate: odds of having just been kidnapped",
              [](Settings& s) { s.localizer.hypothesis_tracker.kidnapped_now_prior = 0.0; }},
    Mechanism{"suspicious-search", "search of the whole map beside a pose that fits badly",
              [](Settings& s) { s.localizer.fit.suspicious_below = 0.0; }},
    Mechanism{"lost-by-verdict", "lost by the verdict wrong",
              [](Settings& s) { s.localizer.fit.lost_by_verdict_s = kNever; }},
    Mechanism{"lost-by-misfit", "lost by misfit", [](Settings& s) { s.localizer.fit.lost_below = 0.0; }},
    Mechanism{"unproven-weight", "less weight of tiles that have not proven to stay",
              [](Settings& s) { s.localizer.judgement.verdict.unproven_weight = 1.0; }},
    Mechanism{"unproven-limit", "limit of P(pose right) without proven tiles",
              [](Settings& s) { s.localizer.judgement.verdict.unproven_limit = 1.0; }},
    Mechanism{"changed-map", "map called wrong rather than right where many beams miss it",
              [](Settings& s) { s.localizer.judgement.verdict.changed_above = 1.0; }},
    Mechanism{"scan-break", "signs of a carried robot: break between scans",
              [](Settings& s) {
                auto& scan_break = s.localizer.judgement.scan_break;
                scan_break.most = scan_break.most_one_way = 1.0;
              }},
};

constexpr std::array kOfMapping{
    Mechanism{"evidence", "method evidence: the published one in its place",
              [](Settings& s) { s.mapping.store_scan.method = MappingMethod::kPaper; }},
    Mechanism{"small-objects", "long persistence of small free-standing objects",
              [](Settings& s) { s.mapping.store_scan.evidence.passing.small_m = 0.0; }},
    Mechanism{"toggling", "long persistence of what comes and goes",
              [](Settings& s) { s.mapping.store_scan.evidence.passing.flips.toggles_from = kNever; }},
    Mechanism{"face-persistence", "persistence of any other change",
              [](Settings& s) { s.mapping.store_scan.evidence.face_persistence_s = 0.0; }},
    Mechanism{"changed-this-run", "quicker removal of what this run has written",
              [](Settings& s) {
                auto& evidence = s.mapping.store_scan.evidence;
                evidence.changed_this_run_persistence_s = evidence.face_persistence_s;
              }},
    Mechanism{"joining", "blocks beside a proven region taken along",
              [](Settings& s) {
                auto& evidence = s.mapping.store_scan.evidence;
                evidence.joining_votes = evidence.joining_gone_votes = kNever;
              }},
    Mechanism{"least-region", "least size of a region",
              [](Settings& s) { s.mapping.store_scan.evidence.least_blocks = 1; }},
    Mechanism{"wear", "wear of votes by those of the other side",
              [](Settings& s) { s.mapping.store_scan.evidence.votes.wear = 0.0; }},
    Mechanism{"redraw-queue", "later looks at written regions",
              [](Settings& s) { s.mapping.store_scan.evidence.redraw_queue.looks = 0; }},
    Mechanism{"scan-placement", "scans placed on the map before they draw",
              [](Settings& s) {
                s.mapping.update.evidence.placement.least_points = std::numeric_limits<std::uint32_t>::max();
              }},
    Mechanism{"enclosed-space", "enclosed free space becomes unknown",
              [](Settings& s) { s.mapping.update.evidence.most_enclosed_m2 = 0.0; }},
    Mechanism{"small-groups", "small groups of new occupied cells left out",
              [](Settings& s) { s.mapping.update.evidence.least_group_cells = 1; }},
    Mechanism{"other-share", "write gate: share of another pose hypothesis",
              [](Settings& s) { s.mapping.store_scan.gate.most_other_share = 1.0; }},
    Mechanism{"spread", "write gate: a pose that is spread wide or that nothing in view holds",
              [](Settings& s) {
                auto& gate = s.mapping.store_scan.gate;
                gate.most_deviation_m = kNever;
                gate.least_expected = 0;
              }},
    Mechanism{"confirming", "write gate: a pose confirmed after it was wrong",
              [](Settings& s) {
                auto& gate = s.mapping.store_scan.gate;
                gate.confirm_s = gate.confirm_m = gate.confirm_followed_s = gate.confirm_followed_m = 0.0;
              }},
    Mechanism{"held-sets", "finished sets that wait for a sign",
              [](Settings& s) { s.mapping.store_scan.gate.hold_s = 0.0; }},
    Mechanism{"held-by-share", "finished sets that wait while another hypothesis holds a share",
              [](Settings& s) { s.mapping.store_scan.gate.hold_other_share = 1.0; }},
    Mechanism{"provisional", "withdrawal of what is provisional",
              [](Settings& s) {
                auto& window = s.mapping.store_scan.gate.provisional;
                window.way_m = window.time_s = 0.0;
              }},
};

bool is_asked(const SettingKey& key, const Settings& delivered) {
  const bool of_the_algorithm = key.name.starts_with("localization.") || key.name.starts_with("mapping.") ||
                                key.name == "laser.range_deviation_m";
  const bool is_on =
      delivered.mapping.store_scan.method == MappingMethod::kPaper || !key.name.starts_with("mapping.paper.");
  return of_the_algorithm && is_on && key.affects_result && key.name != "mapping.enabled";
}

AblationChange assigned(std::string name, const SettingKey& key, std::string value) {
  std::string what = "`" + key.name + "`: " + value + " in place of " + key.text();
  return {std::move(name), std::move(what), [name = key.name, value = std::move(value)](Settings& settings) {
            for (const SettingKey& own : daemon::keys_of(settings)) {
              if (own.name == name) (void)own.assign({daemon::SettingValue::Kind::kScalar, {value}});
            }
          }};
}

void add_scaled(const SettingKey& key, const std::string& name, double factor, std::vector<AblationChange>& changes) {
  const double was = std::stod(key.text());
  double value = std::clamp(factor * was, key.low.value_or(-kNever), key.high.value_or(kNever));
  if (key.type == SettingKey::Type::kWhole) value = std::round(value);
  if (value != was) changes.push_back(assigned(name + "-" + key.name, key, text_of(value)));
}

}  // namespace

std::vector<AblationChange> switched_off(const Settings& delivered) {
  std::vector<AblationChange> changes;
  Settings settings = delivered;
  for (const SettingKey& key : daemon::keys_of(settings)) {
    if (!is_asked(key, delivered) || key.type != SettingKey::Type::kFlag) continue;
    const bool is_on = key.text() == "true";
    changes.push_back(assigned((is_on ? "off-" : "on-") + key.name, key, is_on ? "false" : "true"));
  }
  const auto add = [&changes](const Mechanism& one) {
    changes.push_back({"off-" + std::string{one.name}, std::string{one.what}, one.switch_off});
  };
  std::for_each(kOfLocalization.begin(), kOfLocalization.end(), add);
  std::for_each(kOfMapping.begin(), kOfMapping.end(), add);
  return changes;
}

std::vector<AblationChange> halved_and_doubled(const Settings& delivered) {
  std::vector<AblationChange> changes;
  Settings settings = delivered;
  for (const SettingKey& key : daemon::keys_of(settings)) {
    const bool is_number = key.type == SettingKey::Type::kNumber || key.type == SettingKey::Type::kWhole;
    if (!is_asked(key, delivered) || !is_number) continue;
    add_scaled(key, "half", 0.5, changes);
    add_scaled(key, "twice", 2.0, changes);
  }
  return changes;
}

}  // namespace deltamap::experiments
