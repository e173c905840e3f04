// SPDX-License-Identifier: Apache-2.0
// A drive through a drawn hall that changes, with the evidence method from scans to map: the map follows.
#pragma once

#include <functional>
#include <memory>
#include <utility>

#include "core/random.hpp"
#include "mapping/map_update.hpp"
#include "mapping/map_update_params.hpp"
#include "mapping/store_scan.hpp"
#include "tests/support/scans/drawn_scan.hpp"
#include "tests/support/scans/map_requests.hpp"
#include "tests/support/worlds/drawn_hall.hpp"

namespace deltamap::mapping {

using World = std::function<OccupancyGrid(double time_s)>;

/// Drives to and fro below the containers of the hall, and lets the map follow.
class MappedDrive {
 public:
  explicit MappedDrive(OccupancyGrid first) : map{std::make_shared<const OccupancyGrid>(std::move(first))} {
    noise.position_deviation_m = 0.02;
    noise.heading_deviation_rad = 0.004;
  }

  void through(const World& world, double duration_s, double speed_m_per_s = 0.4) {
    constexpr double kPeriod_s = 0.2;
    for (double t = 0.0; t < duration_s; t += kPeriod_s, time_s += kPeriod_s) {
      const Pose2 pose = test::below_the_containers(time_s, speed_m_per_s);
      TrackedScan tracked = test::drawn_scan(world(time_s), map, pose, time_s, random, noise);
      tracked.estimate.belief.is_on_new_ground = is_on_new_ground;
      const auto set = test::set_in(store.observe(tracked));
      if (!set) continue;
      const scan_set::MapUpdate update = map_update(*map, *set, {});
      if (!update.accepted()) continue;
      ++revisions;
      map = std::make_shared<const OccupancyGrid>(patched(*map, update.changes));
    }
  }

  std::shared_ptr<const OccupancyGrid> map;
  StoreScan store{StoreScanParams{}, 1};
  Random random{5};
  test::DrawnScanParams noise;
  double time_s = 0.0;
  int revisions = 0;
  bool is_on_new_ground = false;
};

inline OccupancyGrid hall() { return test::drawn_hall(0.05); }

inline OccupancyGrid hall_with(Point2 low, Point2 high, CellState state) {
  OccupancyGrid grid = hall();
  test::fill(grid, low, high, state);
  return grid;
}

inline World always(OccupancyGrid grid) {
  return [grid = std::move(grid)](double) { return grid; };
}

}  // namespace deltamap::mapping
