// SPDX-License-Identifier: Apache-2.0
// Someone who walks along a path, stops, and walks on; waits for the robot, turns back where the way is blocked, and
// leaves the path where it is blocked both ways.
#pragma once

#include <cmath>
#include <span>
#include <vector>

#include "core/random.hpp"
#include "simulation/movers/beat.hpp"
#include "simulation/world/ray_caster.hpp"

namespace deltamap::simulation {

struct PersonParams {
  std::vector<Point2> path;    ///< corners of the way, m, at least two
  bool closed = false;         ///< from the last corner on to the first; else back the way one came
  double speed_m_per_s = 1.2;  ///< > 0
  double radius_m = 0.2;       ///< of the body in the laser's plane, > 0
  double walk_least_s = 5.0;   ///< shortest and longest time between stops
  double walk_most_s = 25.0;
  double stand_least_s = 2.0;  ///< shortest and longest stop
  double stand_most_s = 20.0;
};

class Person {
 public:
  Person(PersonParams params, Random random);

  /// `leaves` are those of doors.
  void move(double dt_s, const RayCaster& world, const Circle& robot, std::span<const Segment> leaves = {});

  [[nodiscard]] Circle body() const { return {position_, params_.radius_m}; }
  /// Where the body is so many seconds from now; negative: was.
  [[nodiscard]] Circle body_after(double seconds) const { return {position_ + seconds * velocity_, params_.radius_m}; }

 private:
  void look_for_another_way();
  [[nodiscard]] bool is_blocked(const Point2& next, const Point2& direction, const RayCaster& world,
                                const Circle& robot, std::span<const Segment> leaves) const;

  PersonParams params_;
  Random random_;
  Beat beat_;
  Point2 position_;
  Point2 velocity_{0.0, 0.0};
  bool standing_ = false;
  double phase_left_s_ = 0.0;
  double blocked_s_ = 0.0;
  double since_blocked_m_ = HUGE_VAL;  // walked since the way was shut
};

}  // namespace deltamap::simulation
