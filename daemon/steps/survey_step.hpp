// SPDX-License-Identifier: Apache-2.0
// What is done with each message of a first drive through a building: odometry and scans to SLAM, no localizer and no
// map. `deltamap map build` does so with recorded bytes, an experiment with a virtual robot.
#pragma once

#include <vector>

#include "core/messages.hpp"
#include "daemon/outputs/outputs.hpp"
#include "daemon/settings/settings.hpp"
#include "localization/motion/odometry_buffer.hpp"
#include "surveying/slam/slam.hpp"

namespace deltamap::daemon {

class SurveyStep {
 public:
  explicit SurveyStep(const Settings& settings);

  /// What follows belongs to another drive, which has begun anywhere.
  void begin_drive();
  void observe(const Odometry& odometry) { odometry_.add(odometry); }
  /// False: no odometry is known for the scan, it is left out.
  bool observe(Scan scan);
  /// After the last scan. False: the measurements do not settle, the poses are worth nothing.
  [[nodiscard]] bool finish() { return slam_.finish(); }

  [[nodiscard]] const surveying::slam::Slam& slam() const { return slam_; }
  /// Where each scan that was not left out was taken, in the survey's frame: at a keyframe, or from there on by the
  /// wheels.
  [[nodiscard]] std::vector<TrajectoryPoint> trajectory() const;

 private:
  struct SurveyedScan {
    Timestamp time;
    std::uint32_t keyframe = 0;  // the newest
    Pose2 keyframe_from_robot;
  };

  localization::motion::OdometryBufferParams odometry_params_;
  double range_deviation_m_;
  localization::motion::OdometryBuffer odometry_;
  surveying::slam::Slam slam_;
  std::vector<SurveyedScan> scans_;
};

}  // namespace deltamap::daemon
