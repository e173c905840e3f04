// SPDX-License-Identifier: Apache-2.0
// Drives about so that everything reachable gets seen: straight on where it is clear, round what stands in the way, out
// of dead ends, and now and then off in another direction. Needs no pose and no map: only what the scan saw, what else
// is known to stand about, and the odometry to know how far it has turned. Never reverses: the laser looks ahead only.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "core/geometry/angle.hpp"
#include "core/messages.hpp"
#include "core/random.hpp"
#include "navigation/free_path.hpp"

namespace deltamap::navigation {

struct WanderParams {
  double speed_m_per_s = 0.5;                  ///< where it is clear; > 0
  double turn_rate_rad_per_s = radians(46.0);  ///< on the spot; > 0
  double robot_radius_m = 0.26;                ///< swing circle of the P3-DX; > 0
  double side_clearance_m = 0.15;              ///< kept to both sides while driving; more than safety's margin
  double turn_away_m = 0.45;                   ///< free path at which it stops and turns; > 0
  double slow_down_m = 1.5;                    ///< free path below which it goes slower; > turn_away_m
  double go_on_m = 0.9;                        ///< free path that ends a turn; > turn_away_m
  double shortest_leg_s = 8.0;                 ///< before it thinks of another direction; > 0
  double longest_leg_s = 25.0;                 ///< >= shortest_leg_s
  ObstacleParams obstacles{};
};

class Wander {
 public:
  Wander(const WanderParams& params, std::uint64_t seed) : params_{params}, random_{seed} {}

  /// What to do after this scan; hand it to Safety, which has the last word. `also_in_robot`: obstacles besides those
  /// that the scan saw.
  [[nodiscard]] DriveCommand step(const TrackedScan& tracked, std::span<const Point2> also_in_robot = {});

  [[nodiscard]] const WanderParams& params() const { return params_; }
  /// In the middle of a run: from the next step on. A turn or a leg that was begun is ended.
  void set_params(const WanderParams& params) { params_ = params; }

 private:
  /// A turn on the spot. The side is kept to the end, so that a corner cannot make the robot waver.
  struct Turn {
    double left_to_go_rad;  // > 0, whichever the side
    double side;            // +1 counter-clockwise, -1 clockwise
    double last_heading_rad;
    std::uint32_t epoch;  // of the odometry that measures it
    Timestamp give_up_at;
  };
  struct Field {
    double right_rad;  // bearings of the outermost beams in the robot's frame
    double left_rad;
  };
  void look(const Scan& scan, std::span<const Point2> also_in_robot);
  void plan_leg(Timestamp from);
  void begin_turn(const TrackedScan& tracked, double by_rad);
  /// Whether it still has to turn; ends the turn where not.
  [[nodiscard]] bool keeps_turning(const TrackedScan& tracked, double free_ahead_m);
  [[nodiscard]] double free_towards_m(double bearing_rad) const;
  /// A bearing that leads somewhere, at least so far from straight on: the freer, the likelier. None in a dead end.
  [[nodiscard]] std::optional<double> open_bearing(double least_turn_rad);
  [[nodiscard]] double more_open_side() const;
  [[nodiscard]] DriveCommand turning(Timestamp time) const;
  [[nodiscard]] DriveCommand driving(Timestamp time) const;

  WanderParams params_;
  Random random_;
  std::vector<Point2> obstacles_;  // in the robot's frame
  Field field_{};
  std::optional<Turn> turn_;
  std::optional<Timestamp> leg_ends_;
};

}  // namespace deltamap::navigation
