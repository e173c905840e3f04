// SPDX-License-Identifier: Apache-2.0
#include "experiments/watch/override_map.hpp"

#include "core/grid/grid_ray.hpp"

namespace deltamap::experiments {

bool OverrideMap::is_keyframe(const TrackedScan& tracked) const {
  if (tracked.estimate.state != LocalizerState::kTracking) return false;
  return !last_ || mapping::scan_set::is_next_keyframe(mapping::scan_set::KeyframeParams{}, *last_,
                                                       mapping::scan_set::place_of(tracked));
}

void OverrideMap::set(Cell cell, CellState state) {
  if (map_.geometry().contains(cell)) map_.set(cell, state);
}

void OverrideMap::observe(const TrackedScan& tracked) {
  if (!is_keyframe(tracked)) return;
  last_ = mapping::scan_set::place_of(tracked);
  const Pose2& map_from_robot = tracked.estimate.map_from_robot;
  const auto for_each_range = [&](auto&& take) {
    for (std::size_t i = 0; i < tracked.rays.size(); ++i) {
      if (tracked.scan.beams[i].kind != BeamKind::kRange) continue;
      take(map_from_robot * Point2{tracked.rays[i].origin.cast<double>()},
           map_from_robot * Point2{tracked.rays[i].end.cast<double>()});
    }
  };
  for_each_range([&](const Point2& from, const Point2& end) {
    walk_ray(map_.geometry(), from, end, [&](Cell cell, double) {
      set(cell, CellState::kFree);
      return true;
    });
  });
  for_each_range([&](const Point2&, const Point2& end) { set(map_.geometry().cell_at(end), CellState::kOccupied); });
}

}  // namespace deltamap::experiments
