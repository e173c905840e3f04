// SPDX-License-Identifier: Apache-2.0
// A walled yard of 24 m × 16 m in which boxes and people stand, and a robot that looks at bays of 2.4 m × 2.4 m.
#pragma once

#include <gtest/gtest.h>

#include <utility>
#include <vector>

#include "mapping/bays/bays.hpp"
#include "tests/support/scans/cast_scan.hpp"
#include "tests/support/scans/seen_scan.hpp"

namespace deltamap::mapping::bays {

inline Polygon square(Point2 low, double side_m) {
  return {low, {low.x() + side_m, low.y()}, {low.x() + side_m, low.y() + side_m}, {low.x(), low.y() + side_m}};
}

class SeenBays : public testing::Test {
 protected:
  static constexpr double kSide_m = 2.4;
  static inline const Point2 kBay{8.0, 8.0};                   // its lower left corner
  static inline const Pose2 kBefore{9.2, 4.0, radians(90.0)};  // 4 m before its front
  static inline const Pose2 kAside{5.0, 5.0, radians(45.0)};   // sees its front and its left side
  static inline const GridGeometry kYard{480, 320, 0.05, {0.0, 0.0}};

  SeenBays() { rebuild({}); }

  struct Placed {
    Point2 low;
    Point2 size;
  };
  /// The yard with these and no others in it.
  void rebuild(const std::vector<Placed>& placed) {
    world = OccupancyGrid{kYard, CellState::kFree};
    test::fill_box(world, {0.0, 0.0}, {24.0, 0.1}, CellState::kOccupied);
    test::fill_box(world, {0.0, 15.9}, {24.0, 16.0}, CellState::kOccupied);
    test::fill_box(world, {0.0, 0.0}, {0.1, 16.0}, CellState::kOccupied);
    test::fill_box(world, {23.9, 0.0}, {24.0, 16.0}, CellState::kOccupied);
    for (const Placed& one : placed) test::fill_box(world, one.low, one.low + one.size, CellState::kOccupied);
  }
  /// Five scans a second from there, of a pose that is off by 2 cm and 0.3°.
  std::vector<BayEvent> look(const Pose2& from, double for_s, bool pose_holds = true) {
    std::vector<BayEvent> all;
    for (int i = 0; i < static_cast<int>(5.0 * for_s + 0.5); ++i) {
      now += duration_from_seconds(0.2);
      TrackedScan tracked = test::seen_scan(world, from, 0.015, random, 30.0);
      tracked.scan.time = now;
      tracked.estimate.map_from_robot = test::disturbed(from, 0.02, radians(0.3), random);
      const std::vector<BayEvent> told = bays.observe(tracked, pose_holds);
      all.insert(all.end(), told.begin(), told.end());
    }
    return all;
  }
  [[nodiscard]] const BayStatus& status(std::size_t bay = 0) const { return bays.statuses()[bay]; }
  [[nodiscard]] double age_s(std::size_t bay = 0) const { return seconds(now - *status(bay).seen); }

  OccupancyGrid world{kYard};
  Random random{3};
  Timestamp now = timestamp_from_ns(1'000'000'000'000);
  Bays bays{{Bay{.id = "B4", .polygon = square(kBay, kSide_m)}}};
};

}  // namespace deltamap::mapping::bays
