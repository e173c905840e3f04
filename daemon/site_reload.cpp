// SPDX-License-Identifier: Apache-2.0
#include "daemon/site_reload.hpp"

#include <stdexcept>

#include "core/counted.hpp"
#include "daemon/site/zones_file.hpp"

namespace deltamap::daemon {

SharedSite begun_site(StartMap& start, const Settings& settings, const std::function<void(const std::string&)>& warn) {
  if (!start.site) start.site = site_on(start.map->geometry(), settings.bays.file, settings.zones.file);
  const auto& robot = settings.initial_pose ? settings.initial_pose : start.remembered;
  if (!robot) return start.site;
  for (const std::string& line : zones_over(robot->position(), start.site->zones)) warn(line);
  return start.site;
}

void reload_site(const Settings& settings, const GridGeometry& map, const SiteInForce& in_force,
                 LiveSettings::Outcome& outcome) {
  const auto refuse = [&](const std::string& why) {
    outcome.done = false;
    outcome.lines.push_back("bays and zones stay as they are: " + why);
  };
  SharedSite wanted;
  try {
    wanted = site_on(map, settings.bays.file, settings.zones.file);
  } catch (const std::runtime_error& error) {
    return refuse(error.what());
  }
  if (*wanted == *in_force.newest.newest()) return;
  if (!in_force.sites.try_send(SharedSite{wanted})) return refuse("the daemon is busy, try again");
  in_force.newest.set(wanted);
  outcome.lines.push_back("taken: " + counted(wanted->bays.size(), "bay") + ", " +
                          counted(wanted->zones.size(), "zone"));
  for (std::string& line : warnings_of(*wanted, in_force.telemetry)) outcome.lines.push_back(std::move(line));
}

std::vector<std::string> warnings_of(const Site& site, const Telemetry& telemetry) {
  const EstimateGauges& robot = telemetry.estimate;
  if (robot.state.value() != static_cast<std::uint8_t>(LocalizerState::kTracking)) return {};
  return zones_over({robot.x_m.value(), robot.y_m.value()}, site.zones);
}

}  // namespace deltamap::daemon
