// SPDX-License-Identifier: Apache-2.0
#include "simulation/devices/robot_kind.hpp"

#include <array>
#include <utility>

namespace deltamap::simulation::devices {

RobotKind kind_of(std::string_view subtype) {
  constexpr std::array<std::pair<std::string_view, RobotKind>, 7> kKinds{{
      {"p3dx-sh", {0.001, kHalfTrack_m, 0.25}},
      {"p3dx", {0.000485, kHalfTrack_m, 0.25}},
      {"p3at-sh", {0.001, 0.2941, 0.5}},
      {"p3at", {0.000465, 0.2941, 0.5}},
      {"powerbot-sh", {0.001, 0.2681, 0.55}},
      {"peoplebot-sh", {0.001, 0.1667, 0.34}},
      {"", {}},
  }};
  RobotKind kind;
  std::size_t longest = 0;
  for (const auto& [beginning, known] : kKinds) {
    if (!subtype.starts_with(beginning) || beginning.size() < longest) continue;
    longest = beginning.size();
    kind = known;
  }
  return kind;
}

}  // namespace deltamap::simulation::devices
