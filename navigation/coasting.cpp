// SPDX-License-Identifier: Apache-2.0
#include "navigation/coasting.hpp"

#include <algorithm>
#include <cmath>

namespace deltamap::navigation {
namespace {

constexpr double kStepS = 0.1;       // 0.05 m at 0.5 m/s: between two places a disc of 0.3 m misses 1 mm
constexpr double kNearerM = 1.0e-3;  // less is no approach

/// A rate one step nearer to its target.
double approached(double now, double target, double acceleration, double deceleration, double dt_s) {
  const bool is_slowing = std::abs(target) < std::abs(now) || now * target < 0.0;
  const double step = (is_slowing ? deceleration : acceleration) * dt_s;
  return now + std::clamp(target - now, -step, step);
}

class Walk {
 public:
  explicit Walk(const Coasting& coasting) : coasting_{coasting}, motion_{coasting.at_first} {
    path_.poses.push_back(pose_);
  }

  void go_on(double for_s) { go_towards(motion_, for_s); }
  void go_towards(Motion target, double for_s) {
    while (for_s > 0.0) {
      const double dt_s = std::min(kStepS, for_s);
      step(target, dt_s);
      for_s -= dt_s;
    }
  }
  void brake() {
    const double linear_s = std::abs(motion_.speed_m_per_s) / coasting_.deceleration_m_per_s2;
    go_towards({0.0, 0.0}, linear_s);
  }
  [[nodiscard]] CoastingPath path() && { return std::move(path_); }

 private:
  void step(const Motion& target, double dt_s) {
    const Motion before = motion_;
    motion_.speed_m_per_s = approached(before.speed_m_per_s, target.speed_m_per_s, coasting_.acceleration_m_per_s2,
                                       coasting_.deceleration_m_per_s2, dt_s);
    motion_.turn_rate_rad_per_s =
        approached(before.turn_rate_rad_per_s, target.turn_rate_rad_per_s, coasting_.turn_acceleration_rad_per_s2,
                   coasting_.turn_deceleration_rad_per_s2, dt_s);
    const double ahead_m = 0.5 * (before.speed_m_per_s + motion_.speed_m_per_s) * dt_s;
    const double turn_rad = 0.5 * (before.turn_rate_rad_per_s + motion_.turn_rate_rad_per_s) * dt_s;
    const double along_rad = pose_.theta + 0.5 * turn_rad;
    pose_.x += ahead_m * std::cos(along_rad);
    pose_.y += ahead_m * std::sin(along_rad);
    pose_.theta += turn_rad;
    path_.poses.push_back(pose_);
    path_.length_m += std::abs(ahead_m);
    path_.turned_rad = std::max(path_.turned_rad, std::abs(pose_.theta));
  }

  const Coasting& coasting_;
  Motion motion_;
  Pose2 pose_;
  CoastingPath path_;
};

}  // namespace

CoastingPath coasting_path(const Coasting& coasting) {
  Walk walk{coasting};
  walk.go_on(coasting.at_first_s);
  walk.go_towards(coasting.then, coasting.then_s);
  walk.brake();
  return std::move(walk).path();
}

bool is_clear(const CoastingPath& path, std::span<const Point2> obstacles_in_robot, double radius_m) {
  return std::none_of(obstacles_in_robot.begin(), obstacles_in_robot.end(), [&](const Point2& point) {
    const double at_first_m = point.norm();
    if (at_first_m > path.length_m + radius_m) return false;
    const double least_m = std::min(radius_m, at_first_m - kNearerM);
    return std::any_of(path.poses.begin(), path.poses.end(),
                       [&](const Pose2& pose) { return (point - pose.position()).norm() < least_m; });
  });
}

bool is_looked_at(const CoastingPath& path, const Fan& fan, double radius_m) {
  return std::all_of(path.poses.begin(), path.poses.end(), [&](const Pose2& pose) {
    return looks_at(fan, pose * Point2{radius_m, 0.0});
  });
}

}  // namespace deltamap::navigation
