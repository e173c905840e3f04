// SPDX-License-Identifier: Apache-2.0
// Drives a simulated robot about by where it truly is: from one place of the free floor to another, drawn by chance or
// in a given round.
// It keeps to the middle of corridors, waits for people and doors, and looks for another way where it is held up.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "core/random.hpp"
#include "simulation/robot/robot.hpp"
#include "simulation/world/passages.hpp"

namespace deltamap::simulation {

struct RoutePilotParams {
  double speed_m_per_s = 0.5;        ///< on a straight way, > 0
  double turn_rate_rad_per_s = 0.8;  ///< at most, > 0
  double clearance_m = 0.45;         ///< of the robot's centre from every surface, > its radius
  double comfort_m = 1.0;            ///< the same, where there is room, >= clearance_m
  double least_way_m = 6.0;          ///< from where it is to the next place, >= 0
  double sight_m = 1.0;              ///< in which it stops for a person ahead, > 0
  double patience_s = 4.0;           ///< before it looks for another way, > 0
  std::vector<Point2> round{};       ///< places that it drives to in turn, again and again; none: drawn by chance
};

class RoutePilot {
 public:
  RoutePilot(const RoutePilotParams& params, const World& world, const Point2& from, Random random);

  /// Containers have come or gone: the way is thought over.
  void see(const World& world, const Point2& from);

  /// What to drive for the next dt_s seconds.
  [[nodiscard]] devices::DriveTarget target(const RobotState& robot, const Bodies& bodies, double dt_s);

  [[nodiscard]] bool reaches(const Point2& place) const { return floor_.contains(place); }
  /// A place on the floor with room around it, and any heading.
  [[nodiscard]] Pose2 place_anywhere(Random& random) const;

 private:
  [[nodiscard]] devices::DriveTarget towards(const Point2& place, const Pose2& map_from_robot) const;
  [[nodiscard]] bool someone_ahead(const Pose2& map_from_robot, std::span<const Circle> people) const;
  [[nodiscard]] bool leaf_ahead(const Pose2& map_from_robot, std::span<const Segment> leaves) const;
  [[nodiscard]] bool is_open(const Point2& from, const Point2& to, const ReachableFloor& floor) const;
  [[nodiscard]] Point2 carrot(const Point2& from);
  [[nodiscard]] std::optional<Cell> drawn_goal(const Point2& from, bool however_near);
  [[nodiscard]] std::optional<Cell> goal_of_round(const Point2& from);
  void plan(const Point2& from, std::span<const Circle> avoided = {});
  void forget_way() { way_.clear(); }

  RoutePilotParams params_;
  ReachableFloor floor_;      // with clearance
  ReachableFloor roomy_;      // with comfort
  std::vector<Cell> places_;  // of the roomy floor
  Random random_;
  std::vector<Point2> way_;  // to the goal, a floor cell apart
  std::size_t next_ = 0;     // of the way
  std::size_t place_ = 0;    // of the round
  double waited_s_ = 0.0;
  double backing_left_s_ = 0.0;
};

}  // namespace deltamap::simulation
