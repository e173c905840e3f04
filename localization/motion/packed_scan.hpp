// SPDX-License-Identifier: Apache-2.0
// A scan and its rays in 12 bytes a beam, for those who keep thousands of them: all that maps are drawn of comes back
// bit for bit.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <memory>
#include <vector>

#include "core/messages.hpp"
#include "localization/motion/odometry_buffer.hpp"

namespace deltamap::localization::motion {

class PackedScan {
 public:
  PackedScan() = default;
  /// `velocity`: of the robot during the sweep. What does not differ from `like` is shared with it; may be null.
  PackedScan(const Scan& scan, const BodyVelocity& velocity = {}, const PackedScan* like = nullptr);

  [[nodiscard]] Timestamp time() const { return time_; }
  [[nodiscard]] double range_deviation_m() const { return range_deviation_m_; }
  /// Beams.
  [[nodiscard]] std::size_t size() const { return ranges_m_.size(); }
  /// It has a range, and none longer than that.
  [[nodiscard]] bool ends_within(std::size_t beam, double longest_m) const {
    return ranges_m_[beam] >= 0.0F && static_cast<double>(ranges_m_[beam]) <= longest_m;
  }
  /// RayInRobot::end.
  [[nodiscard]] const Eigen::Vector2f& end(std::size_t beam) const { return ends_[beam]; }
  /// Of the beams that end within so much, in order of bearing.
  [[nodiscard]] std::vector<Point2> ends(double longest_m) const;

  /// Its beams and rays. Beams without a range are kNotValid; nothing else is known.
  [[nodiscard]] TrackedScan tracked() const;

 private:
  /// What all scans of a laser have in common.
  struct Sweep {
    Pose2 robot_from_laser;
    std::vector<float> offsets_s;
    friend bool operator==(const Sweep&, const Sweep&) = default;
  };

  Timestamp time_;
  double range_deviation_m_ = kRangeDeviationM;
  BodyVelocity velocity_;
  std::shared_ptr<const Sweep> sweep_;
  std::vector<float> ranges_m_;  // below 0: none
  std::vector<Eigen::Vector2f> ends_;
};

}  // namespace deltamap::localization::motion
