// SPDX-License-Identifier: Apache-2.0
#include "simulation/movers/actor.hpp"

#include <algorithm>
#include <cmath>

#include "simulation/movers/manners.hpp"

namespace deltamap::simulation {
namespace {

constexpr double kRoomToOthers_m = 0.3;  // between bodies
constexpr double kStopRoom_m = 2.0;      // from the robot: nearer it does not stop, nor come in by the gate
constexpr double kTurnRate_rad_per_s = 1.2;

double gap_between(std::span<const Circle> cover, const Circle& other) {
  double least_m = 1e9;
  for (const Circle& part : cover) {
    least_m = std::min(least_m, (part.centre - other.centre).norm() - part.radius_m - other.radius_m);
  }
  return least_m;
}

double gap_between(std::span<const Circle> cover, const Segment& leaf) {
  double least_m = 1e9;
  for (const Circle& part : cover) {
    least_m = std::min(least_m, distance_between(part.centre, leaf) - part.radius_m);
  }
  return least_m;
}

}  // namespace

Actor::Actor(ActorParams params, Random random)
    : params_{std::move(params)}, random_{random}, beat_{params_.path, params_.closed} {
  const Point2 way = params_.path[1] - params_.path[0];
  map_from_body_ = {params_.path[0].x(), params_.path[0].y(), std::atan2(way.y(), way.x())};
  left_s_ = random_.uniform(params_.walk_least_s, params_.walk_most_s);
}

void Actor::move(double dt_s, const Surroundings& around) {
  left_s_ -= dt_s;
  if (mood_ == Mood::kAway) {
    if (left_s_ <= 0.0) come_back(around);
    return;
  }
  if (mood_ == Mood::kStanding) {
    if (left_s_ > 0.0) return;
    end_stop();
  }
  const bool may_stop = !leaving_ && gate_leg_ == GateLeg::kNone;
  if (left_s_ <= 0.0 && may_stop && gap_between(cover(), around.robot) > kStopRoom_m) {
    mood_ = Mood::kStanding;
    left_s_ = log_uniform(params_.stop_least_s, params_.stop_most_s);
    return;
  }
  walk(dt_s, around);
}

void Actor::end_stop() {
  mood_ = Mood::kWalking;
  left_s_ = random_.uniform(params_.walk_least_s, params_.walk_most_s);
  leaving_ = params_.gate && random_.uniform() < params_.leave_share;
}

void Actor::walk(double dt_s, const Surroundings& around) {
  if ((aim() - map_from_body_.position()).norm() <= params_.speed_m_per_s * dt_s) {
    reach_aim();
    return;
  }
  const Pose2 next = step_towards(aim(), dt_s);
  if (is_blocked(next, around)) {
    blocked_s_ += dt_s;
    if (blocked_s_ > kPatience_s) turn_back();
    return;
  }
  blocked_s_ = 0.0;
  map_from_body_ = next;
}

/// A fork-lift turns on the spot before it goes on at a corner; where it was blocked it backs out as it came.
Pose2 Actor::step_towards(const Point2& aim, double dt_s) const {
  const Point2 way = aim - map_from_body_.position();
  const Point2 ahead = backs_ ? Point2{-way} : way;
  const double bearing_rad = std::atan2(ahead.y(), ahead.x());
  const double off_rad = turn_between(map_from_body_.theta, bearing_rad);
  Pose2 next = map_from_body_;
  const double most_rad = kTurnRate_rad_per_s * dt_s;
  if (params_.is_forklift && std::abs(off_rad) > most_rad) {
    next.theta = wrapped_angle(next.theta + std::copysign(most_rad, off_rad));
    return next;
  }
  const Point2 there = map_from_body_.position() + params_.speed_m_per_s * dt_s * way.normalized();
  return {there.x(), there.y(), bearing_rad};
}

/// Whether a step would bring the body too near to something that it is not already leaving.
bool Actor::is_blocked(const Pose2& next, const Surroundings& around) const {
  const std::vector<Circle> now = cover();
  const std::vector<Circle> then = cover_at(next);
  const auto closes_in = [&](const auto& thing, double room_m) {
    const double gap_m = gap_between(then, thing);
    return gap_m < room_m && gap_m < gap_between(now, thing);
  };
  if (closes_in(around.robot, kRoomToRobot_m)) return true;
  if (std::any_of(around.others.begin(), around.others.end(),
                  [&](const Circle& other) { return closes_in(other, kRoomToOthers_m); }))
    return true;
  if (std::any_of(around.leaves.begin(), around.leaves.end(),
                  [&](const Segment& leaf) { return closes_in(leaf, kRoomToSurface_m); }))
    return true;
  const Point2 step = next.position() - map_from_body_.position();
  return std::any_of(then.begin(), then.end(), [&](const Circle& part) {
    const auto nearest = around.world.nearest_surface(part.centre, part.radius_m + kRoomToSurface_m);
    return nearest && nearest->direction.dot(step) > 0.0;
  });
}

void Actor::reach_aim() {
  backs_ = false;
  if (gate_leg_ == GateLeg::kOut) {
    mood_ = Mood::kAway;
    leaving_ = false;
    left_s_ = log_uniform(params_.away_least_s, params_.away_most_s);
  } else if (gate_leg_ == GateLeg::kIn) {
    gate_leg_ = GateLeg::kNone;
    left_s_ = random_.uniform(params_.walk_least_s, params_.walk_most_s);
    beat_.reach();
  } else if (leaving_ && beat_.aims_at_first()) {
    gate_leg_ = GateLeg::kOut;
  } else {
    beat_.reach();
  }
}

void Actor::come_back(const Surroundings& around) {
  const Point2 way = params_.path[0] - *params_.gate;
  const Pose2 map_from_gate{params_.gate->x(), params_.gate->y(), std::atan2(way.y(), way.x())};
  const std::vector<Circle> body = cover_at(map_from_gate);
  if (gap_between(body, around.robot) < kStopRoom_m) return;
  for (const Circle& other : around.others) {
    if (gap_between(body, other) < kRoomToOthers_m) return;
  }
  map_from_body_ = map_from_gate;
  mood_ = Mood::kWalking;
  gate_leg_ = GateLeg::kIn;
  beat_.begin_anew();
}

void Actor::turn_back() {
  blocked_s_ = 0.0;
  backs_ = params_.is_forklift && !backs_;
  if (gate_leg_ == GateLeg::kNone) {
    beat_.turn_back();
  } else {
    leaving_ = gate_leg_ == GateLeg::kIn;
    gate_leg_ = leaving_ ? GateLeg::kOut : GateLeg::kIn;
  }
}

const Point2& Actor::aim() const { return gate_leg_ == GateLeg::kOut ? *params_.gate : beat_.aim(); }

Box Actor::box_at(const Pose2& map_from_body) const {
  const double round_m = 2.0 * params_.radius_m;
  return params_.is_forklift ? Box{map_from_body.position(), params_.length_m, params_.width_m, map_from_body.theta}
                             : Box{map_from_body.position(), round_m, round_m, map_from_body.theta};
}

std::vector<Circle> Actor::cover_at(const Pose2& map_from_body) const {
  if (params_.is_forklift) return cover_of(box_at(map_from_body));
  return {{map_from_body.position(), params_.radius_m}};
}

double Actor::log_uniform(double least, double most) {
  return least * std::exp(random_.uniform() * std::log(most / least));
}

}  // namespace deltamap::simulation
