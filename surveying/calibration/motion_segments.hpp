// SPDX-License-Identifier: Apache-2.0
// Pairs what the wheels say with where the localizer went: a drive is cut into segments, and of each is kept by how
// much the two disagree and what the motion model (motion_model.hpp) makes of the steps in it. For
// motion_calibration.hpp.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "core/geometry/angle.hpp"
#include "core/geometry/pose2.hpp"

namespace deltamap::surveying::calibration {

/// Where a segment ends: the lengths and turns take turns, so that errors of the estimate, which do not grow on the
/// way, can be told from those of the wheels, which do.
struct MotionSegmentsParams {
  double step_m = 0.05;            ///< a step of the filter: driven, m; > 0 (localization.update.distance_m)
  double step_rad = radians(2.0);  ///< or heading turned in one, rad; > 0 (localization.update.turn_deg)
  std::array<double, 4> length_m{0.3, 0.6, 1.2, 2.4};
  std::array<double, 4> turn_rad{radians(20.0), radians(40.0), radians(80.0), radians(160.0)};
};

/// What may disturb a segment, each with the covariance that its unit deviation gives the segment's end.
enum class MotionSource : std::uint8_t {
  kTurnPerTurn,
  kTurnPerMetre,
  kMetrePerMetre,
  kMetrePerTurn,
  kEstimatePosition,  ///< the localizer's own error at both ends, m
  kEstimateHeading    ///< its own error of heading at both ends, rad
};
inline constexpr std::size_t kMotionSources = 6;

struct MotionSegment {
  Eigen::Vector3d disagreement{0.0, 0.0, 0.0};  ///< estimate less wheels at the end, in the segment's first robot frame
  std::array<Eigen::Matrix3d, kMotionSources> covariance{};
  Eigen::Matrix3d by_scale = Eigen::Matrix3d::Zero();  ///< ∂end / ∂(wheel scale, turn scale, drift per metre)
  double driven_m = 0.0;
  double turned_rad = 0.0;
};

class MotionSegments {
 public:
  explicit MotionSegments(const MotionSegmentsParams& params) : params_{params} {}

  struct Moment {
    Pose2 odom_from_robot;
    std::uint32_t odometry_epoch = 0;
    Pose2 map_from_robot;  ///< estimated
    bool is_sure = false;  ///< false ends the segment without using it
  };
  void observe(const Moment& moment);

  [[nodiscard]] const std::vector<MotionSegment>& segments() const { return segments_; }

 private:
  void begin(const Moment& moment);
  void close(const Moment& moment);

  MotionSegmentsParams params_;
  std::vector<MotionSegment> segments_;
  std::optional<Moment> first_;
  std::vector<Pose2> steps_;  ///< poses at the ends of the open segment's steps, in the frame of its start
  double driven_m_ = 0.0;
  double turned_rad_ = 0.0;
};

/// The segment of a robot whose wheels say that it went from the origin through these poses, and that ended there.
[[nodiscard]] MotionSegment motion_segment(const std::vector<Pose2>& first_from_step, const Pose2& first_from_end);

}  // namespace deltamap::surveying::calibration
