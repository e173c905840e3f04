// SPDX-License-Identifier: Apache-2.0
// What is done with each message of a first drive through a building: odometry and scans to SLAM, no localizer and no
// map. `deltamap map build` does so with recorded bytes, an experiment with a virtual robot.
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "core/messages.hpp"
#include "daemon/outputs/outputs.hpp"
#include "daemon/settings/settings.hpp"
#include "surveying/slam/drive_odometry.hpp"
#include "surveying/slam/slam.hpp"

namespace deltamap::daemon {

class SurveyStep {
 public:
  explicit SurveyStep(const Settings& settings);
  SurveyStep(const SurveyStep&) = delete;
  SurveyStep& operator=(const SurveyStep&) = delete;

  /// What follows belongs to another drive, which has begun anywhere.
  void begin_drive();
  void observe(const Odometry& odometry) { odometry_->observe(odometry); }
  void observe(Scan scan) { odometry_->observe(std::move(scan)); }
  /// After the last message of a drive. Answers how many of its scans take part; the others have no odometry.
  std::size_t end_drive();
  /// After the last drive. False: the measurements do not settle, the poses are worth nothing.
  [[nodiscard]] bool finish();

  [[nodiscard]] const surveying::slam::Slam& slam() const { return slam_; }
  /// Where each scan that was not left out was taken, in the survey's frame: at a keyframe, or from there on by wheels
  /// and scans.
  [[nodiscard]] std::vector<TrajectoryPoint> trajectory() const;

 private:
  struct SurveyedScan {
    Timestamp time;
    std::uint32_t keyframe = 0;  // the newest
    Pose2 keyframe_from_robot;
  };
  void take(surveying::slam::MovedScan&& moved);

  localization::motion::OdometryBufferParams odometry_params_;
  double range_deviation_m_;
  std::optional<surveying::slam::DriveOdometry> odometry_;  // of this drive
  surveying::slam::Slam slam_;
  std::vector<SurveyedScan> scans_;
  std::size_t scans_before_ = 0;  // this drive
};

}  // namespace deltamap::daemon
