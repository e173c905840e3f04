// SPDX-License-Identifier: Apache-2.0
// What is read of other programs' messages: planar scans, poses of the robot and transforms, in ROS 1's and ROS 2's
// (CDR) bytes and as JSON, Foxglove's schemas among them.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "core/geometry/pose2.hpp"
#include "core/time.hpp"
#include "tool/import/message_file.hpp"

namespace deltamap::tool {

/// A frame in the plane whose z axis points up or down: what lies in one that hangs upside down is mirrored.
struct PlanarPose {
  Pose2 pose{};  ///< theta: of its x axis
  bool is_upside_down = false;
};
[[nodiscard]] inline PlanarPose operator*(const PlanarPose& a_from_b, const PlanarPose& b_from_c) {
  const Pose2& within = b_from_c.pose;
  return {a_from_b.pose * (a_from_b.is_upside_down ? Pose2{within.x, -within.y, -within.theta} : within),
          a_from_b.is_upside_down != b_from_c.is_upside_down};
}

struct RosScan {
  Timestamp time;  ///< of the first beam
  std::string frame;
  PlanarPose frame_from_scan;  ///< where its beams begin; Foxglove's scans tell it
  double first_bearing_rad = 0.0;
  double bearing_step_rad = 0.0;  ///< negative: clockwise
  double min_range_m = 0.0;       ///< shorter: not valid
  double max_range_m = 0.0;       ///< longer: no return; 0: not told
  std::vector<float> ranges_m;    ///< as they stand: infinite, NaN and 0 among them
};

struct RosPose {
  Timestamp time;
  std::string frame;  ///< in which it is told
  std::string child;  ///< whose pose it is; may be empty
  PlanarPose at;
};

/// Whether scans, and whether poses or transforms, are read from messages of this type and encoding.
[[nodiscard]] bool is_read_as_scan(std::string_view type, std::string_view encoding);
[[nodiscard]] bool is_read_as_poses(std::string_view type, std::string_view encoding);

/// A list of transforms between any frames, or one.
[[nodiscard]] bool holds_transforms(std::string_view type);

/// Throws std::runtime_error: why it is not what its type says.
[[nodiscard]] RosScan scan_in(const MessageView& message);
/// The pose of an Odometry, a PoseStamped or a PoseInFrame; all transforms of a TFMessage. Throws as scan_in().
[[nodiscard]] std::vector<RosPose> poses_in(const MessageView& message);

}  // namespace deltamap::tool
