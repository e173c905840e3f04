// SPDX-License-Identifier: Apache-2.0
// A robot among a few surfaces, some of which were seen before, for tests of what slips explain.
#pragma once

#include <cmath>
#include <cstdint>
#include <span>
#include <vector>

#include "localization/motion/motion_model.hpp"
#include "localization/surfaces/slip_search.hpp"

namespace deltamap::localization::surfaces::slip_test {

inline const PoseCovariance kKnown = Eigen::Vector3d{2.5e-5, 2.5e-5, 1e-6}.asDiagonal();
inline const PoseCovariance kSlip = Eigen::Vector3d{0.04, 0.04, 0.0076}.asDiagonal();

inline Surface facing(const Point2& normal, const Point2& centre) {
  return {.centre = centre, .normal = normal, .half_length_m = 1.0};
}

/// A robot that stands at the origin by its wheels, and the surfaces around it.
class Surroundings {
 public:
  Surroundings() { state_.start({Pose2{}, kKnown}); }

  /// Followed, and last seen `stands_m` along its normal from where the map has it.
  std::size_t follow(const Surface& surface, double stands_m, double unseen_m) {
    const bool holds = std::abs(stands_m) < 0.05;
    switches_.push_back({.surface = surface, .holds = holds ? 1.0 : 0.0, .unseen_m = unseen_m});
    state_.append(stands_m, 0.01, 0.003);
    return switches_.size() - 1;
  }
  /// The scan shows it, from where the robot truly is; a followed one stands where it was last seen.
  void show(const Surface& surface, double stands_m, const Pose2& truth, int followed_as) {
    const auto number = static_cast<std::int32_t>(records_.size());
    records_.push_back({.surface = surface, .followed_as = followed_as});
    Sighting sighting{.id = {0, number}, .surface = surface, .beams = 21.0};
    const Pose2 robot_from_map = inverse(truth);
    const auto end = [&](int i) {
      return Point2{robot_from_map * Point2{surface.centre + stands_m * surface.normal + 0.05 * i * surface.tangent()}};
    };
    for (int i = -10; i <= 10; ++i) sighting.mean += end(i) / sighting.beams;
    for (int i = -10; i <= 10; ++i) sighting.scatter += (end(i) - sighting.mean) * (end(i) - sighting.mean).transpose();
    sightings_.push_back(sighting);
    if (followed_as >= 0) in_view_.push_back(static_cast<std::size_t>(followed_as));
  }

  /// Followed, in view at the last keyframe, and shown where it was last seen.
  void keep_in_view(const Surface& surface, double stands_m, const Pose2& truth) {
    constexpr double kSinceThenM = 0.2;
    show(surface, stands_m, truth, static_cast<int>(follow(surface, stands_m, kSinceThenM)));
  }
  /// The surface shown last stood there at an earlier visit.
  void remember(double stood_m) { records_.back().offset_m = stood_m; }

  [[nodiscard]] SlipReading::Answer best_near(const Pose2& pose, SlipTime when, const PoseCovariance& slip) const {
    std::vector<bool> in_view(switches_.size());
    for (const std::size_t number : in_view_) in_view[number] = true;
    const SlipScene seen = scene();
    return SlipReading{state_, switches_, when, slip, in_view}.best_near(pose, seen.seen_as_followed, seen.record_of);
  }
  /// How much better a slip near a pose explains what is seen than none, nats.
  [[nodiscard]] double gain(const Pose2& near, SlipTime when) const {
    return best_near(near, when, kSlip).evidence - best_near({}, when, PoseCovariance::Zero()).evidence;
  }

  [[nodiscard]] SlipScene scene() const {
    const auto seen = [this](const Pose2&) { return std::span<const Sighting>{sightings_}; };
    return {.state = state_,
            .switches = switches_,
            .sightings = sightings_,
            .motion = motion_,
            .seen_as_followed = seen,
            .seen_as_mapped = seen,
            .record_of = [this](SurfaceMap::Id id) -> const SurfaceRecord& {
              return records_[static_cast<std::size_t>(id.number)];
            }};
  }

 private:
  motion::MotionModelParams motion_;
  OffsetState state_;
  std::vector<SurfaceSwitch> switches_;
  std::vector<SurfaceRecord> records_;
  std::vector<Sighting> sightings_;
  std::vector<std::size_t> in_view_;
};

inline const Surface kLeft = facing({0.0, -1.0}, {1.0, 2.0});
inline const Surface kRight = facing({0.0, 1.0}, {1.0, -2.0});
inline const Surface kAhead = facing({-1.0, 0.0}, {5.0, 0.0});

/// Walls to either side, seen from where the robot truly is.
inline Surroundings aisle_from(const Pose2& truth) {
  Surroundings around;
  for (const Surface& wall : {kLeft, kRight}) around.keep_in_view(wall, 0.0, truth);
  return around;
}

}  // namespace deltamap::localization::surfaces::slip_test
