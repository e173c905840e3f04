// SPDX-License-Identifier: Apache-2.0
#include "daemon/site_reload.hpp"

#include <cstdio>
#include <stdexcept>

#include "core/counted.hpp"
#include "navigation/borders_in_reach.hpp"

namespace deltamap::daemon {

namespace {

std::string words_of_reach(const navigation::BordersInReach& borders, double reach_m) {
  std::string words = "the border of blocked zone ";
  for (const std::string& id : borders.ids) words += (&id == &borders.ids.front() ? "'" : ", '") + id + "'";
  char reach[32];
  (void)std::snprintf(reach, sizeof reach, "%.2f m", reach_m);
  words += " is within " + std::string(reach) + " of the robot's middle, where its hull and its margin reach: ";
  return words + (borders.leave_a_way ? "it turns, and drives straight away from the border alone"
                                      : "it turns, and no way ahead is left: draw the border farther away");
}

}  // namespace

std::vector<std::string> zones_over(const Point2& robot_in_map, const Zones& zones,
                                    const navigation::SafetyParams& safety) {
  std::vector<std::string> lines;
  for (const Zone& zone : zones) {
    if (zone.kind != ZoneKind::kBlocked || !contains(zone.polygon, robot_in_map)) continue;
    lines.push_back("zone '" + zone.id +
                    "' is BLOCKED and lies over the robot's own place: it may leave, and does not come back");
  }
  const double reach_m = safety.robot_radius_m + safety.margin_m;
  const navigation::BordersInReach borders = navigation::borders_in_reach(zones, robot_in_map, reach_m);
  if (!borders.ids.empty()) lines.push_back(words_of_reach(borders, reach_m));
  return lines;
}

SharedSite begun_site(StartMap& start, const Settings& settings, const std::function<void(const std::string&)>& warn) {
  if (!start.site) start.site = site_on(start.map->geometry(), settings.bays.file, settings.zones.file);
  const auto& robot = settings.initial_pose ? settings.initial_pose : start.remembered;
  if (!robot) return start.site;
  for (const std::string& line : zones_over(robot->position(), start.site->zones, settings.navigation.safety))
    warn(line);
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
  for (std::string& line : warnings_of(*wanted, settings, in_force.telemetry)) outcome.lines.push_back(std::move(line));
}

std::vector<std::string> warnings_of(const Site& site, const Settings& settings, const Telemetry& telemetry) {
  const EstimateGauges& robot = telemetry.estimate;
  if (robot.state.value() != static_cast<std::uint8_t>(LocalizerState::kTracking)) return {};
  return zones_over({robot.x_m.value(), robot.y_m.value()}, site.zones, settings.navigation.safety);
}

}  // namespace deltamap::daemon
