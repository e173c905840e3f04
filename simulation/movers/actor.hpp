// SPDX-License-Identifier: Apache-2.0
// A person or a fork-lift that walks its beat, stops anywhere for seconds or for an hour, and may leave the hall
// through a gate and come back. It keeps off the robot and off the others, and never stops beside the robot.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "core/random.hpp"
#include "simulation/movers/beat.hpp"
#include "simulation/world/bodies.hpp"
#include "simulation/world/ray_caster.hpp"

namespace deltamap::simulation {

struct ActorParams {
  std::vector<Point2> path;    ///< corners of the way, m, at least two
  bool closed = false;         ///< from the last corner on to the first; else back the way one came
  bool is_forklift = false;    ///< a box of length_m by width_m; else round
  double speed_m_per_s = 1.2;  ///< > 0
  double radius_m = 0.2;       ///< of a person in the laser's plane, > 0
  double length_m = 2.4;       ///< of a fork-lift, > 0
  double width_m = 1.2;        ///< of a fork-lift, > 0
  double walk_least_s = 10.0;  ///< shortest and longest time between stops, uniform
  double walk_most_s = 60.0;
  double stop_least_s = 5.0;  ///< shortest and longest stop, log-uniform, > 0
  double stop_most_s = 3600.0;
  std::optional<Point2> gate{};  ///< outside of the hall, in a straight line from the path's first corner
  double leave_share = 0.3;      ///< of stops after which it leaves by the gate, [0, 1]
  double away_least_s = 30.0;    ///< shortest and longest time outside, log-uniform, > 0
  double away_most_s = 600.0;
};

class Actor {
 public:
  Actor(ActorParams params, Random random);

  /// What an actor looks out for.
  struct Surroundings {
    const RayCaster& world;
    Circle robot;
    std::span<const Circle> others;   ///< actors
    std::span<const Segment> leaves;  ///< of doors
  };
  void move(double dt_s, const Surroundings& around);

  [[nodiscard]] bool is_in_hall() const { return mood_ != Mood::kAway; }
  [[nodiscard]] bool is_standing() const { return mood_ == Mood::kStanding; }
  [[nodiscard]] bool is_forklift() const { return params_.is_forklift; }
  /// A person stands in a square.
  [[nodiscard]] Box box() const { return box_at(map_from_body_); }
  [[nodiscard]] Circle person() const { return {map_from_body_.position(), params_.radius_m}; }
  [[nodiscard]] std::vector<Circle> cover() const { return cover_at(map_from_body_); }

 private:
  enum class Mood : std::uint8_t { kWalking, kStanding, kAway };
  /// On the way between the gate and the first corner.
  enum class GateLeg : std::uint8_t { kNone, kOut, kIn };

  void end_stop();
  void walk(double dt_s, const Surroundings& around);
  void come_back(const Surroundings& around);
  void reach_aim();
  void turn_back();
  [[nodiscard]] const Point2& aim() const;
  [[nodiscard]] Pose2 step_towards(const Point2& aim, double dt_s) const;
  [[nodiscard]] bool is_blocked(const Pose2& next, const Surroundings& around) const;
  [[nodiscard]] Box box_at(const Pose2& map_from_body) const;
  [[nodiscard]] std::vector<Circle> cover_at(const Pose2& map_from_body) const;
  [[nodiscard]] double log_uniform(double least, double most);

  ActorParams params_;
  Random random_;
  Beat beat_;
  Pose2 map_from_body_;
  Mood mood_ = Mood::kWalking;
  GateLeg gate_leg_ = GateLeg::kNone;
  bool leaving_ = false;
  bool backs_ = false;   // a fork-lift, tail first
  double left_s_ = 0.0;  // of the walk, the stop or the time outside
  double blocked_s_ = 0.0;
};

}  // namespace deltamap::simulation
