// SPDX-License-Identifier: Apache-2.0
#include "simulation/movers/person.hpp"

#include <algorithm>

#include "simulation/movers/manners.hpp"

namespace deltamap::simulation {
namespace {

constexpr double kFewSteps_m = 8.0;  // to and fro across an aisle of 4 m

}  // namespace

Person::Person(PersonParams params, Random random)
    : params_{std::move(params)},
      random_{random},
      beat_{params_.path, params_.closed},
      position_{params_.path.front()} {
  phase_left_s_ = random_.uniform(params_.walk_least_s, params_.walk_most_s);
}

void Person::move(double dt_s, const RayCaster& world, const Circle& robot, std::span<const Segment> leaves) {
  phase_left_s_ -= dt_s;
  if (phase_left_s_ <= 0.0) {
    standing_ = !standing_;
    phase_left_s_ = standing_ ? random_.uniform(params_.stand_least_s, params_.stand_most_s)
                              : random_.uniform(params_.walk_least_s, params_.walk_most_s);
  }
  velocity_ = Point2{0.0, 0.0};
  if (standing_) return;

  const double step_m = params_.speed_m_per_s * dt_s;
  const Point2 way = beat_.aim() - position_;
  if (way.norm() <= step_m) {
    beat_.reach();
    blocked_s_ = 0.0;
    return;
  }
  const Point2 direction = way.normalized();
  const Point2 next = position_ + step_m * direction;
  if (is_blocked(next, direction, world, robot, leaves)) {
    blocked_s_ += dt_s;
    if (blocked_s_ > kPatience_s) look_for_another_way();
    return;
  }
  blocked_s_ = 0.0;
  velocity_ = params_.speed_m_per_s * direction;
  position_ = next;
  since_blocked_m_ += step_m;
}

/// Back where one came from. Who has walked but a few steps since the way was shut before is shut in on the beat, and
/// goes to any other corner of it.
void Person::look_for_another_way() {
  if (since_blocked_m_ < kFewSteps_m && beat_.corners() > 2) {
    beat_.head_for_other(random_.index_below(static_cast<std::uint32_t>(beat_.corners() - 1)));
  } else {
    beat_.turn_back();
  }
  blocked_s_ = 0.0;
  since_blocked_m_ = 0.0;
}

bool Person::is_blocked(const Point2& next, const Point2& direction, const RayCaster& world, const Circle& robot,
                        std::span<const Segment> leaves) const {
  const Point2 to_robot = robot.centre - next;
  if (to_robot.norm() < params_.radius_m + robot.radius_m + kRoomToRobot_m && to_robot.dot(direction) > 0.0)
    return true;
  const auto closes_in = [&](const Segment& leaf) {
    const double gap_m = distance_between(next, leaf);
    return gap_m < params_.radius_m + kRoomToSurface_m && gap_m < distance_between(position_, leaf);
  };
  if (std::any_of(leaves.begin(), leaves.end(), closes_in)) return true;
  const auto nearest = world.nearest_surface(next, params_.radius_m + kRoomToSurface_m);
  return nearest && nearest->direction.dot(direction) > 0.0;
}

}  // namespace deltamap::simulation
