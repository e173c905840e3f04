// SPDX-License-Identifier: Apache-2.0
#include "daemon/settings/former_keys.hpp"

#include <array>
#include <sstream>
#include <string_view>
#include <utility>

namespace deltamap::daemon {
namespace {

using Section = std::pair<std::string_view, std::string_view>;  // its name, and its keys

constexpr std::array<Section, 29> kFixed{{
    {"robot", "pulse_interval_s sip_timeout_s"},
    {"laser", "power_on_wait_s scan_timeout_s"},
    {"localization.particles", "evidence_beams"},
    {"localization", "gap_s"},
    {"localization.update", "time_s"},
    {"localization.motion",
     "position_floor_m heading_floor_deg unknown_speed_m_per_s unknown_turn_rate_deg_per_s slip_m slip_deg"},
    {"localization.wheels",
     "metre_per_root_metre turn_per_root_metre_deg turn_per_root_turn_deg stretch_m stretch_deg"},
    {"localization.odometry", "extrapolation_s max_speed_m_per_s max_turn_rate_deg_per_s"},
    {"localization.field", "unknown_likelihood"},
    {"localization.refinement", "steps prior_share longest_shift_m largest_turn_deg alike_beams"},
    {"localization.track", "agreement"},
    {"localization.temporary", "least_share_left belief"},
    {"localization.hypothesis", "cell_m heading_cell_deg"},
    {"localization.fit",
     "lost_below found_above lost_after_s lost_nowhere_after_s memory_s search_after_s search_after_m "
     "converged_share converged_m converged_deg converged_after_deg lost_by_verdict_s "
     "distrusted_after_s distrust suspicious_below converged_unfit_after_m"},
    {"localization.global", "places places_a_scan again_after_m again_after_deg"},
    {"localization.places",
     "most most_while_believing beams evidence_beams step_m step_deg memory_steps hopeless same_m same_deg"},
    {"localization.rivals",
     "probes probes_nearby nearby_m nearby_deg nearby_prior carried_prior held_by "
     "prior_after_search kidnapped_prior refined_a_scan winning_share wins_after_m beats_by equal_within "
     "block_m most_ahead suspicious_pace images images_a_scan headings"},
    {"localization.stability", "apart_s apart_m proven_after tile_m earn_right_above earn_deviation_m"},
    {"localization.beam_check",
     "after_m after_deg after_s deviations hit_deviation_m least_position_deviation_m "
     "least_heading_deviation_deg most_aside_m beyond_m"},
    {"localization.verdict",
     "beams right_above wrong_below unproven_limit lost_in_a_view least_wrong view_m view_deg view_s "
     "short_weight unproven_weight least_beams doubt_after_search views_after_search views_of_suspicion "
     "unique_for_views proof_memory_views changed_above"},
    {"localization.memory", "stability_period_s position_deviation_m heading_deviation_deg"},
    {"mapping.evidence",
     "least_votes least_added_share least_removed_share least_blocks settle_s most_wait_s forget_s"},
    {"mapping.evidence.update",
     "least_scans most_implausible_share occupied_hit_share free_hit_share least_speck_cells "
     "least_acceptance"},
    {"mapping.temporary", "least_votes most_votes lapse_s most_blocks"},
    {"mapping.gate",
     "disbelieved_below most_rival_share most_deviation_m jump_m confirm_s confirm_m most_misfit "
     "most_break most_break_one_way wary_break wary_s most_doubt_s hold_s hold_rival_share provisional_m "
     "provisional_s"},
    {"mapping.paper", "most_scans"},
    {"mapping.paper.update", "least_scans most_chi2"},
    {"navigation.safety", "reaction_s command_life_s odometry_life_s low_battery_s plausible_s"},
    {"navigation.wander", "turn_away_m slow_down_m go_on_m"},
}};

constexpr std::array<std::pair<std::string_view, std::string_view>, 4> kRenamed{
    {{"localization.fit.converged_after_m", "localization.global.converged_after_m"},
     {"localization.rivals.elsewhere_prior", "localization.kidnapping_prior"},
     {"localization.refinement.range_deviation_m", "laser.range_deviation_m"},
     {"mapping.evidence.range_deviation_m", "laser.range_deviation_m"}}};

}  // namespace

std::map<std::string, std::string> former_keys() {
  std::map<std::string, std::string> keys{kRenamed.begin(), kRenamed.end()};
  for (const auto& [section, names] : kFixed) {
    std::istringstream words{std::string{names}};
    for (std::string name; words >> name;) keys.emplace(std::string{section} + "." + name, "");
  }
  return keys;
}

}  // namespace deltamap::daemon
