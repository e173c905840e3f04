// SPDX-License-Identifier: Apache-2.0
// Drives about so that everything reachable gets seen: straight on where it is clear, round what stands in the way, out
// of dead ends, and now and then off in another direction. Needs no pose and no map: only what the scan saw, and the
// odometry to know how far it has turned. Never reverses: the laser looks ahead only.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "core/messages.hpp"
#include "core/random.hpp"
#include "navigation/free_path.hpp"

namespace deltamap::navigation {

struct WanderParams {
  double speed_m_per_s = 0.5;        ///< where it is clear; > 0
  double turn_rate_rad_per_s = 0.8;  ///< on the spot; > 0
  double robot_radius_m = 0.26;      ///< swing circle of the P3-DX; > 0
  double side_clearance_m = 0.15;    ///< kept to both sides while driving; more than safety's margin
  double turn_away_m = 0.45;         ///< free path at which it stops and turns; > 0
  double slow_down_m = 1.5;          ///< free path below which it goes slower; > turn_away_m
  double go_on_m = 0.9;              ///< free path that ends a turn; > turn_away_m
  double shortest_leg_s = 8.0;       ///< before it thinks of another direction; > 0
  double longest_leg_s = 25.0;       ///< >= shortest_leg_s
  ObstacleParams obstacles;
};

class Wander {
 public:
  Wander(const WanderParams& params, std::uint64_t seed);

  /// What to do after this scan; send it to Safety, which has the last word.
  [[nodiscard]] DriveCommand step(const TrackedScan& tracked);

 private:
  struct Turn {
    double to_rad;  // heading in the odometry's frame
    double side;    // +1 to the left, -1 to the right: kept to the end, so that a corner cannot make it waver
    std::uint32_t epoch;
    Timestamp give_up_at;
  };
  [[nodiscard]] std::optional<DriveCommand> go_on_turning(const TrackedScan& tracked, double free_ahead_m);
  [[nodiscard]] DriveCommand begin_turn(const TrackedScan& tracked, double by_rad);
  [[nodiscard]] DriveCommand drive(const TrackedScan& tracked) const;
  [[nodiscard]] double free_towards_m(double bearing_rad) const;
  /// A direction out of here: the freer, the likelier; none where nothing is open.
  [[nodiscard]] std::optional<double> open_direction(double least_turn_rad);
  void plan_leg(Timestamp from);

  WanderParams params_;
  Random random_;
  std::vector<Point2> obstacles_;  // of the present scan, in the robot's frame
  std::optional<Turn> turn_;
  std::optional<Timestamp> leg_ends_;
};

}  // namespace deltamap::navigation
