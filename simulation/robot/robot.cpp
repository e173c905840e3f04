// SPDX-License-Identifier: Apache-2.0
#include "simulation/robot/robot.hpp"

#include <algorithm>
#include <cmath>

namespace deltamap::simulation {
namespace {

/// A speed one step nearer to its target: decelerating towards zero, accelerating away from it.
double approached(double now, double target, double acceleration, double deceleration, double dt_s) {
  const bool slowing = std::abs(target) < std::abs(now) || now * target < 0.0;
  const double step = (slowing ? deceleration : acceleration) * dt_s;
  return now + std::clamp(target - now, -step, step);
}

/// The motion of the robot's centre while its wheels roll, along a circular arc.
Pose2 arc(double left_m, double right_m, double half_track_m) {
  const double forward_m = 0.5 * (left_m + right_m);
  const double turn_rad = (right_m - left_m) / (2.0 * half_track_m);
  const double half = 0.5 * turn_rad;
  const double chord_m = std::abs(half) < 1e-9 ? forward_m : forward_m * std::sin(half) / half;
  return {chord_m * std::cos(half), chord_m * std::sin(half), turn_rad};
}

}  // namespace

RobotParams with_wheel_errors(RobotParams body, const WheelErrors& errors) {
  const double ground_of_encoder = 1.0 / (1.0 + errors.scale);
  const double true_of_nominal_track = (1.0 + errors.turn) * ground_of_encoder;
  const double drift = errors.drift_rad_per_m * ground_of_encoder * true_of_nominal_track * body.half_track_m;
  body.track_error = true_of_nominal_track - 1.0;
  body.left_wheel_error = ground_of_encoder - 1.0 + drift;
  body.right_wheel_error = ground_of_encoder - 1.0 - drift;
  return body;
}

Robot::Robot(const RobotParams& params, const Pose2& map_from_start, Random random)
    : params_{params}, random_{random}, left_{params.left_wheel_error, 0.0}, right_{params.right_wheel_error, 0.0} {
  state_.map_from_robot = map_from_start;
}

void Robot::move(const devices::DriveTarget& target, double dt_s, const RayCaster& world,
                 std::span<const Circle> people) {
  double speed = approached(state_.speed_m_per_s, target.speed_m_per_s, target.acceleration_m_per_s2,
                            target.deceleration_m_per_s2, dt_s);
  double turn_rate = approached(state_.turn_rate_rad_per_s, target.turn_rate_rad_per_s,
                                target.turn_acceleration_rad_per_s2, target.turn_deceleration_rad_per_s2, dt_s);
  if (faults_.wheels_blocked) speed = turn_rate = 0.0;
  if (faults_.pushed_m_per_s != 0.0) speed = faults_.pushed_m_per_s;
  const double half_turn_m = turn_rate * params_.half_track_m * dt_s;
  const double true_track_m = params_.half_track_m * (1.0 + params_.track_error);
  const double left_m = faults_.left_grip * ground_travel_m(left_, speed * dt_s - half_turn_m);
  const double right_m = faults_.right_grip * ground_travel_m(right_, speed * dt_s + half_turn_m);
  const Pose2& towed = faults_.towed_per_s;
  Pose2 moved = state_.map_from_robot * arc(left_m, right_m, true_track_m) *
                Pose2{towed.x * dt_s, towed.y * dt_s, towed.theta * dt_s};

  const auto contact = contact_at(moved.position(), params_.radius_m, world, people);
  const Point2 step = moved.position() - state_.map_from_robot.position();
  const bool held = contact && step.dot(contact->direction) > 0.0;
  const double ground_speed = 0.5 * (faults_.left_grip + faults_.right_grip) * std::abs(speed);
  if (held) {
    moved.x = state_.map_from_robot.x;
    moved.y = state_.map_from_robot.y;
    speed = 0.0;
  }
  const bool is_towed_alone = left_m == 0.0 && right_m == 0.0;
  state_.stalled = held && !is_towed_alone;
  state_.contact.reset();
  if (contact) {
    const double bearing_in_map = std::atan2(contact->direction.y(), contact->direction.x());
    state_.contact = RobotContact{turn_between(moved.theta, bearing_in_map), contact->object, ground_speed};
  }
  state_.map_from_robot = moved;
  if (!faults_.counts_nothing) {
    state_.odom_from_robot =
        state_.odom_from_robot * arc(speed * dt_s - half_turn_m, speed * dt_s + half_turn_m, params_.half_track_m);
  }
  state_.speed_m_per_s = speed;
  state_.turn_rate_rad_per_s = turn_rate;
}

double Robot::ground_travel_m(Wheel& wheel, double encoder_m) {
  const double distance_m = std::abs(encoder_m);
  if (distance_m == 0.0) return 0.0;
  double travel_m =
      encoder_m * (1.0 + wheel.error) + random_.normal(params_.wheel_noise_m_per_sqrt_m) * std::sqrt(distance_m);
  if (wheel.slip_left_m > 0.0) {
    travel_m -= params_.slip_share * encoder_m;
    wheel.slip_left_m -= distance_m;
  } else if (random_.uniform() < params_.slips_per_m * distance_m) {
    wheel.slip_left_m = params_.slip_length_m;
  }
  return travel_m;
}

std::optional<Robot::Contact> Robot::contact_at(const Point2& position, double within_m, const RayCaster& world,
                                                std::span<const Circle> people) const {
  std::optional<Contact> contact;
  if (const auto nearest = world.nearest_surface(position, within_m)) {
    contact = Contact{nearest->distance_m, nearest->direction, nearest->object};
  }
  for (const Circle& person : people) {
    const Point2 to_person = person.centre - position;
    const double distance_m = to_person.norm() - person.radius_m;
    if (distance_m < (contact ? contact->distance_m : within_m)) {
      contact = Contact{distance_m, to_person.normalized(), kMoverId};
    }
  }
  return contact;
}

}  // namespace deltamap::simulation
