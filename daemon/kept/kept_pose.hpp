// SPDX-License-Identifier: Apache-2.0
// What outlives a run besides the revisions of the map: where the robot stood last, and what was learned of its wheels
// and its laser's mount. A small file beside the store,
// replaced whole every few seconds and at the stop, so that a start after a crash or a power cut finds the robot where
// it was left. Belongs to one M_0: a pose in another map means nothing.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>

#include "core/messages.hpp"
#include "daemon/outputs/localization_log.hpp"
#include "localization/motion/drive_calibration.hpp"

namespace deltamap::daemon {

struct KeptPose {
  std::uint64_t first_map = 0;  ///< grid_hash() of M_0
  std::uint32_t revision = 0;   ///< of the map that the pose was computed on
  Timestamp time;               ///< of the scan
  Pose2 map_from_robot;
  PoseCovariance covariance = PoseCovariance::Zero();
  bool is_sure = false;  ///< tracking, and nothing spoke against the pose; else a start does not use it
  std::optional<localization::motion::DriveCalibration> calibration{};  ///< a start uses it whatever the pose is worth
};

/// Of the newest scan.
[[nodiscard]] KeptPose kept_pose_of(const LocalizationRow& row, std::uint64_t first_map,
                                    std::optional<localization::motion::DriveCalibration> calibration);

[[nodiscard]] std::string json_text(const KeptPose& pose);

/// The pose that a start may use, or why there is none.
struct KeptPoseAnswer {
  std::optional<KeptPose> pose;
  std::optional<localization::motion::DriveCalibration> calibration{};
  std::uint32_t revision = 0;  ///< of this map, that was written by then, whatever the pose is worth; 0: none is told
  std::string why_not;         ///< one line that names the file; empty where there is none to be read
  std::uint64_t fingerprint = 0;  ///< of the file, where anything in it may be used
};
[[nodiscard]] KeptPoseAnswer read_kept_pose(const std::filesystem::path& file, std::uint64_t first_map);

/// What the log says of it: "begins at the pose that was kept: x=…".
[[nodiscard]] std::string begin_line(const KeptPose& pose);

}  // namespace deltamap::daemon
