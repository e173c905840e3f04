// SPDX-License-Identifier: Apache-2.0
// Bays and zones of a running daemon: read at the start, and again by a reload of the settings.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "core/channel.hpp"
#include "daemon/outputs/newest_board.hpp"
#include "daemon/settings/live_settings.hpp"
#include "daemon/settings/settings.hpp"
#include "daemon/site/site.hpp"
#include "daemon/steps/localization_step.hpp"
#include "daemon/telemetry/telemetry.hpp"

namespace deltamap::daemon {

/// A line each for blocked zones in which the robot stands: it may leave, and never comes back. And for those whose
/// border is within the reach of its hull: what it still can do there.
[[nodiscard]] std::vector<std::string> zones_over(const Point2& robot_in_map, const Zones& zones,
                                                  const navigation::SafetyParams& safety);

/// Those of the settings, which `start` has from then on. Warns as zones_over() of where the robot
/// begins. Throws std::runtime_error: one line that names file and place.
[[nodiscard]] SharedSite begun_site(StartMap& start, const Settings& settings,
                                    const std::function<void(const std::string&)>& warn);

struct SiteInForce {
  const Telemetry& telemetry;
  Channel<SharedSite>& sites;  ///< to those who go by it
  NewestBoard<Site>& newest;
};
/// As zones_over(), where the robot knows its place.
[[nodiscard]] std::vector<std::string> warnings_of(const Site& site, const Settings& settings,
                                                   const Telemetry& telemetry);

/// Tells in `outcome` what was taken, or why nothing was. Never by two threads at once.
void reload_site(const Settings& settings, const GridGeometry& map, const SiteInForce& in_force,
                 LiveSettings::Outcome& outcome);

}  // namespace deltamap::daemon
