// SPDX-License-Identifier: Apache-2.0
// A robot that drives round the drawn hall and can be lifted off its wheels, and a localizer that follows it.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "localization/localizer.hpp"
#include "localization/localizer_params.hpp"
#include "tests/support/scans/cast_scan.hpp"
#include "tests/support/worlds/drawn_hall.hpp"

namespace deltamap::localization::tour_test {

inline constexpr double kScanPeriodS = 0.2;

inline Odometry at_rest() {
  Odometry odometry;
  odometry.time = timestamp_from_ns(1'700'000'000'000'000'000);
  return odometry;
}

/// A robot that drives round the drawn hall and can be lifted off its wheels.
class Tour {
 public:
  explicit Tour(std::uint64_t seed) : random_{seed} {}

  TrackedScan next(Localizer& localizer) {
    step();
    localizer.observe(odometry_);
    return localizer.observe(scan());
  }
  void step() {
    const std::vector<Point2> way{{18.5, 1.0}, {18.5, 7.0}, {1.5, 7.0}, {1.5, 1.0}};
    if ((way[goal_] - truth_.position()).norm() < 0.15) goal_ = (goal_ + 1) % way.size();
    const Point2 to = way[goal_] - truth_.position();
    const double off_rad = turn_between(truth_.theta, std::atan2(to.y(), to.x()));
    const Pose2 motion{std::abs(off_rad) > 0.5 ? 0.0 : 0.1, 0.0, std::clamp(off_rad, -0.15, 0.15)};
    truth_ = truth_ * motion;
    const Pose2 measured{motion.x * (1.02 + random_.normal(0.03)), 0.0, motion.theta * 1.02 + random_.normal(0.003)};
    odometry_.odom_from_robot = odometry_.odom_from_robot * measured;
    wait(kScanPeriodS);
  }
  /// Drives on while no scan comes.
  void drive_unseen(Localizer& localizer, double seconds) {
    for (double left_s = seconds; left_s > 0.0; left_s -= kScanPeriodS) {
      step();
      localizer.observe(odometry_);
    }
  }
  void wait(double seconds) { odometry_.time += duration_from_seconds(seconds); }
  void carry_to(const Pose2& place) {
    truth_ = place;
    goal_ = place.y > 4.0 ? 2 : 0;
  }
  void restart_controller() {
    odometry_.odom_from_robot = {};
    ++odometry_.epoch;
  }
  [[nodiscard]] const Odometry& odometry() const { return odometry_; }
  [[nodiscard]] Scan scan() { return test::cast_scan(world_, truth_, odometry_.time, {}, random_); }
  [[nodiscard]] const Pose2& truth() const { return truth_; }

 private:
  OccupancyGrid world_ = test::drawn_hall();
  Random random_;
  Pose2 truth_{2.0, 1.0, 0.0};
  std::size_t goal_ = 0;
  Odometry odometry_ = at_rest();
};

inline Localizer localizer_at(std::optional<particles::InitialPose> pose, std::uint64_t seed) {
  LocalizerParams params;
  params.particles.max = 2000;
  return Localizer{params, std::make_shared<const OccupancyGrid>(test::drawn_hall()), pose, seed};
}

/// One that was told where the robot is, and has followed it over so many scans.
inline Localizer localizer_after(int scans, Tour& tour, std::uint64_t seed) {
  Localizer localizer = localizer_at(particles::InitialPose{tour.truth()}, seed);
  for (int i = 0; i < scans; ++i) (void)tour.next(localizer);
  return localizer;
}

inline bool right(const TrackedScan& tracked, const Tour& tour) {
  const Pose2& pose = tracked.estimate.map_from_robot;
  return distance_between(pose, tour.truth()) < 0.3 && std::abs(turn_between(pose.theta, tour.truth().theta)) < 0.1;
}

/// Scans until the pose is right and tracked; `most` where it never is.
inline int scans_until_right(Localizer& localizer, Tour& tour, int most) {
  for (int i = 0; i < most; ++i) {
    const TrackedScan tracked = tour.next(localizer);
    if (tracked.estimate.state == LocalizerState::kTracking && right(tracked, tour)) return i;
  }
  return most;
}

}  // namespace deltamap::localization::tour_test
