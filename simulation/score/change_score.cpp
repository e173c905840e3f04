// SPDX-License-Identifier: Apache-2.0
#include "simulation/score/change_score.hpp"

#include <algorithm>
#include <stdexcept>

#include "simulation/score/change_watch.hpp"

namespace deltamap::simulation::score {
namespace {

void count_ghosts(const RayCaster& surfaces, const OccupancyGrid& start_map, const OccupancyGrid& map,
                  ChangeScore& score) {
  const double cell_m2 = map.resolution_m() * map.resolution_m();
  const double near_m = 2.0 * map.resolution_m() + 1e-6;
  for (std::size_t i = 0; i < map.geometry().cell_count(); ++i) {
    const Cell cell = map.geometry().cell_of(i);
    if (map[cell] != CellState::kOccupied || surfaces.nearest_surface(map.geometry().centre_of(cell), near_m)) continue;
    score.ghosts_m2 += cell_m2;
    if (start_map[cell] == CellState::kOccupied) score.stale_ghosts_m2 += cell_m2;
  }
}

}  // namespace

ChangeScore change_score(const Scenario& scenario, const Truth& truth, const OccupancyGrid& start_map,
                         const OccupancyGrid& final_map, const ChangeScoreParams& params) {
  if (!(start_map.geometry() == final_map.geometry())) {
    throw std::runtime_error("the start map and the final map differ in size, resolution or origin");
  }
  ChangeWatch past{scenario, final_map.geometry()};
  auto event = truth.events.begin();
  auto change = truth.changes.begin();
  for (auto pose = truth.poses.begin(); pose != truth.poses.end(); ++pose) {
    for (; change != truth.changes.end() && change->time <= pose->time; ++change)
      past.apply(change->change, change->time, pose->map_from_robot.position());
    for (; event != truth.events.end() && event->time <= pose->time; ++event) past.apply(event->event);
    const auto next = std::next(pose);
    if (next == truth.poses.end() || past.watched().empty()) continue;
    const double lasts_s = std::min(params.longest_look_s, seconds(next->time - pose->time));
    const Pose2 map_from_laser = pose->map_from_robot * scenario.laser.optics.robot_from_laser;
    past.look(past.view_from(map_from_laser, params.range_m, params.beams, past.standing()), lasts_s,
              params.face_beams);
  }
  for (; change != truth.changes.end(); ++change)
    past.apply(change->change, change->time, truth.poses.back().map_from_robot.position());
  for (; event != truth.events.end(); ++event) past.apply(event->event);

  ChangeScore score;
  const World world_at_end = past.world_and_standing();
  past.judge(final_map, drawn_surfaces(world_at_end, final_map.geometry()), params);
  for (const Watched& watched : past.watched()) {
    score.eligible += watched.change.is_eligible ? 1 : 0;
    score.found += watched.change.is_found ? 1 : 0;
    score.changes.push_back(watched.change);
  }
  count_ghosts(RayCaster{world_at_end}, start_map, final_map, score);
  return score;
}

}  // namespace deltamap::simulation::score
