// SPDX-License-Identifier: Apache-2.0
// The first map of a building: simultaneous localization and mapping (SLAM) over one or several drives, off line. Each
// keyframe is matched against the last metres of its drive, about where wheels and scans together say, places that the
// robot comes back to are found again, and the graph of all these measurements gives the poses. drawn_map.hpp draws the
// grid from them.
#pragma once

#include <cstddef>
#include <optional>

#include "core/messages.hpp"
#include "surveying/slam/drive_joining.hpp"
#include "surveying/slam/drive_odometry.hpp"
#include "surveying/slam/keyframe_motion.hpp"
#include "surveying/slam/loop_closing.hpp"
#include "surveying/slam/survey.hpp"

namespace deltamap::surveying::slam {

class Slam {
 public:
  Slam() : loops_{survey_}, joining_{survey_} {}
  Slam(const Slam&) = delete;
  Slam& operator=(const Slam&) = delete;

  /// What follows belongs to another drive, begun anywhere.
  void begin_drive();
  /// Scans of one drive in order of time; those that are no keyframe are passed over.
  void observe(const MovedScan& moved);
  /// After the last scan: all poses at once. False: the measurements do not settle, the poses are worth nothing.
  [[nodiscard]] bool finish();

  [[nodiscard]] const Survey& survey() const { return survey_; }
  [[nodiscard]] const LoopClosing& loops() const { return loops_; }
  /// Is the drive in the first one's frame?
  [[nodiscard]] bool is_joined(std::uint32_t drive) const { return survey_.component[drive] == 0; }
  /// Keyframes that were held to the one before by scan matching; the others stand where their odometry puts them.
  [[nodiscard]] std::size_t matched() const { return matched_; }

 private:
  /// Has the newest drive shown nothing yet?
  [[nodiscard]] bool begins() const;
  void end_drive();
  void follow(const mapping::alignment::PoseLink& moved);
  [[nodiscard]] std::optional<mapping::alignment::PoseLink> matched_link(
      const mapping::alignment::PoseLink& moved) const;

  Survey survey_;
  LoopClosing loops_;
  DriveJoining joining_;
  std::size_t matched_ = 0;
  Pose2 odom_from_robot_;  // of the newest scan
  KeyframeMotion since_keyframe_;
  double driven_m_ = 0.0;  // in this drive
};

}  // namespace deltamap::surveying::slam
