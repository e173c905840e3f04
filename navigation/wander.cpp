// SPDX-License-Identifier: Apache-2.0
#include "navigation/wander.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "core/geometry/angle.hpp"

namespace deltamap::navigation {
namespace {

constexpr double kLookAheadM = 6.0;
constexpr double kTurnDoneRad = 0.1;
constexpr double kSlowTurnRad = 0.35;  // the last part of a turn is slower: scans are up to 0.25 s old
constexpr double kTurnMoreRad = 0.4;   // where a turn has ended before a wall
constexpr double kLongestTurnS = 20.0;
constexpr double kBearingStepRad = 0.1745329;  // 10°
constexpr double kLeastNewDirectionRad = 0.5;
constexpr double kSidePreferenceM = 0.8;  // of free path that one rad/s must gain to be worth a bend
constexpr double kSlowestShare = 0.2;
constexpr std::array<double, 7> kBends{0.0, 0.2, -0.2, 0.4, -0.4, 0.7, -0.7};  // rad/s

}  // namespace

void Wander::look(const Scan& scan, std::span<const Point2> also_in_robot) {
  obstacles_ = obstacles_of(scan, params_.obstacles);
  obstacles_.insert(obstacles_.end(), also_in_robot.begin(), also_in_robot.end());
  const double first = scan.robot_from_laser.theta + scan.first_bearing_rad;
  const double last =
      first + static_cast<double>(scan.beams.empty() ? 0 : scan.beams.size() - 1) * scan.bearing_step_rad;
  field_ = {std::min(first, last), std::max(first, last)};
}

void Wander::plan_leg(Timestamp from) {
  leg_ends_ = from + duration_from_seconds(random_.uniform(params_.shortest_leg_s, params_.longest_leg_s));
}

double Wander::free_towards_m(double bearing_rad) const {
  std::vector<Point2> turned;
  turned.reserve(obstacles_.size());
  const Pose2 turned_from_robot = inverse(Pose2{0.0, 0.0, bearing_rad});
  for (const Point2& point : obstacles_) turned.push_back(turned_from_robot * point);
  return free_path_m(turned, 0.0, params_.robot_radius_m + params_.side_clearance_m, kLookAheadM);
}

std::optional<double> Wander::open_bearing(double least_turn_rad) {
  struct Way {
    double bearing_rad;
    double weight;
  };
  std::vector<Way> ways;
  double sum = 0.0;
  const int steps = static_cast<int>((field_.left_rad - field_.right_rad) / kBearingStepRad);
  for (int i = 0; i <= steps; ++i) {
    const double bearing = field_.right_rad + i * kBearingStepRad;
    if (std::abs(bearing) < least_turn_rad) continue;
    const double free_m = free_towards_m(bearing);
    if (free_m < params_.go_on_m) continue;
    ways.push_back({bearing, free_m * free_m});
    sum += ways.back().weight;
  }
  double drawn = random_.uniform() * sum;
  for (const Way& way : ways) {
    drawn -= way.weight;
    if (drawn < 0.0) return way.bearing_rad;
  }
  return std::nullopt;
}

double Wander::more_open_side() const {
  double left_m = 0.0;
  double right_m = 0.0;
  for (const Point2& point : obstacles_) (point.y() > 0.0 ? left_m : right_m) += std::min(point.norm(), kLookAheadM);
  return left_m >= right_m ? 1.0 : -1.0;
}

void Wander::begin_turn(const TrackedScan& tracked, double by_rad) {
  turn_ = Turn{std::abs(by_rad), by_rad < 0.0 ? -1.0 : 1.0, tracked.odom_from_robot.theta, tracked.odometry_epoch,
               tracked.scan.time + duration_from_seconds(kLongestTurnS)};
  plan_leg(tracked.scan.time);
}

bool Wander::keeps_turning(const TrackedScan& tracked, double free_ahead_m) {
  if (!turn_) return false;
  const double heading_rad = tracked.odom_from_robot.theta;
  turn_->left_to_go_rad -= turn_->side * turn_between(turn_->last_heading_rad, heading_rad);
  turn_->last_heading_rad = heading_rad;
  const bool lost_count = tracked.odometry_epoch != turn_->epoch || tracked.scan.time > turn_->give_up_at;
  if (turn_->left_to_go_rad < kTurnDoneRad && free_ahead_m < params_.go_on_m) turn_->left_to_go_rad += kTurnMoreRad;
  if (lost_count || turn_->left_to_go_rad < kTurnDoneRad) turn_.reset();
  return turn_.has_value();
}

DriveCommand Wander::turning(Timestamp time) const {
  const double share = turn_->left_to_go_rad < kSlowTurnRad ? 0.5 : 1.0;
  return {time, 0.0, turn_->side * share * params_.turn_rate_rad_per_s};
}

/// Straight on, or along the bend that leads clearly further.
DriveCommand Wander::driving(Timestamp time) const {
  const double keep_m = params_.robot_radius_m + params_.side_clearance_m;
  double best_score = -1.0e9;
  double best_bend = 0.0;
  double best_free_m = 0.0;
  for (const double bend : kBends) {
    const double free_m = free_path_m(obstacles_, bend / params_.speed_m_per_s, keep_m, kLookAheadM / 2.0);
    const double score = free_m - kSidePreferenceM * std::abs(bend);
    if (score > best_score) {
      best_score = score;
      best_bend = bend;
      best_free_m = free_m;
    }
  }
  const double share = std::clamp(best_free_m / params_.slow_down_m, kSlowestShare, 1.0);
  return {time, share * params_.speed_m_per_s, share * best_bend};  // the same bend, driven slower
}

DriveCommand Wander::step(const TrackedScan& tracked, std::span<const Point2> also_in_robot) {
  look(tracked.scan, also_in_robot);
  const Timestamp time = tracked.scan.time;
  if (!leg_ends_) plan_leg(time);
  const double free_ahead_m = free_towards_m(0.0);
  if (keeps_turning(tracked, free_ahead_m)) return turning(time);
  const bool blocked = free_ahead_m < params_.turn_away_m;
  if (!blocked && time < *leg_ends_) return driving(time);

  const auto bearing = open_bearing(kLeastNewDirectionRad);
  if (bearing) {
    begin_turn(tracked, *bearing);
  } else if (blocked) {  // a dead end: back to where it came from, more or less
    begin_turn(tracked, more_open_side() * std::numbers::pi * random_.uniform(0.7, 1.0));
  } else {
    plan_leg(time);
    return driving(time);
  }
  return turning(time);
}

}  // namespace deltamap::navigation
