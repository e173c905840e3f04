// SPDX-License-Identifier: Apache-2.0
#include "daemon/settings/settings_sections.hpp"

#include <algorithm>

namespace deltamap::daemon {

const std::vector<SettingSection>& setting_sections() {
  static const std::vector<SettingSection> kSections{
      {"robot", "the robot's controller: port, line and the limits it is set to"},
      {"laser", "the laser: port, line, field of view and where it is mounted"},
      {"laser.mount", "pose of the laser in the robot's frame"},
      {"map", "the first map, and where its revisions are kept"},
      {"map.retention", "which old revisions are kept one by one: those that either rule keeps; without a rule all"},
      {"localization", "where the robot is in the map"},
      {"localization.particles", "how many particles there are and when they are resampled"},
      {"localization.update", "when a scan is weighed again"},
      {"localization.motion", "motion model: how far odometry may be wrong"},
      {"localization.wheels", "noise of the wheels, learned while driving"},
      {"localization.field", "likelihood field: how a beam is weighed by where it ends"},
      {"localization.track", "what gives the pose from scan to scan"},
      {"localization.temporary", "what transient obstacles count for"},
      {"localization.global", "global localization: search of the whole map"},
      {"localization.memory", "what is kept for the next start"},
      {"mapping", "how the map follows the world"},
      {"mapping.evidence", "method evidence: beams vote on what has changed"},
      {"mapping.gate", "write gate: when the pose is sure enough to write to the map"},
      {"mapping.paper", "method paper: Δ-awareness as published"},
      {"mapping.paper.update", "method paper: what a merge must fulfil"},
      {"mapping.things", "bodies that have come, gone or moved, as revisions tell of them"},
      {"navigation", "whether and how the robot drives by itself"},
      {"navigation.safety", "limits that no command exceeds"},
      {"navigation.wander", "driving about: mode wander"},
      {"control", "commands of `deltamap ctl`"},
      {"poses", "the pose of every scan, for other programs"},
      {"dashboard", "the live page for browsers"},
      {"recording", "the recording of both ports"},
      {"incidents", "the minutes around each loss, refusal, safety stop, device fault and operator's mark"},
      {"bays", "the places that goods are put on"},
      {"zones", "areas of the site in which other rules hold"},
  };
  return kSections;
}

std::string meaning_of_section(const std::string& name) {
  const auto& sections = setting_sections();
  const auto found =
      std::find_if(sections.begin(), sections.end(), [&](const SettingSection& one) { return one.name == name; });
  return found == sections.end() ? "" : found->meaning;
}

}  // namespace deltamap::daemon
