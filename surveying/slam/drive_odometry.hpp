// SPDX-License-Identifier: Apache-2.0
// How the robot moved along one drive, by its wheels and its scans together: what the front end of SLAM begins with.
// Off line each scan waits until the wheels' reports around it are known, and the first ones until the wheels' lag is.
#pragma once

#include <cstddef>
#include <deque>
#include <functional>
#include <optional>

#include "core/messages.hpp"
#include "localization/motion/odometry_buffer.hpp"
#include "localization/odometer/scan_witness.hpp"

namespace deltamap::surveying::slam {

/// A scan whose odometry is what wheels and scans tell together, from the first one of its drive on; its estimate holds
/// nothing.
struct MovedScan {
  TrackedScan tracked;
  PoseCovariance deviation = PoseCovariance::Zero();   ///< LaserMotion::deviation
  Eigen::Matrix3d kept = Eigen::Matrix3d::Identity();  ///< LaserMotion::kept
  bool is_torn_off = false;  ///< nobody knows what the robot did since the scan before: the clock has fallen back
};

class DriveOdometry {
 public:
  using Sink = std::function<void(MovedScan&&)>;

  /// `sink` takes the scans in their order. Those for which no report of the wheels speaks are left out.
  DriveOdometry(const localization::motion::OdometryBufferParams& params, double range_deviation_m, Sink sink);

  void observe(const Odometry& odometry);
  void observe(Scan scan);
  /// Nothing more comes: what waits is handed on.
  void end();

  /// How much too late the wheels' stamps are, s; nothing until it is known.
  [[nodiscard]] std::optional<double> lag_s() const;

 private:
  /// The wheels' reports, and the scans beside them.
  struct Witnessed {
    localization::motion::OdometryBuffer wheels;
    localization::odometer::ScanWitness scans;
  };
  void scout(const Scan& scan);
  void hand_on_what_is_due();
  void hand_on(Scan scan);

  double range_deviation_m_;
  Sink sink_;
  std::deque<Scan> waiting_;
  std::optional<Timestamp> newest_report_;
  std::optional<Timestamp> newest_scan_;
  localization::motion::OdometryBuffer reports_;  ///< as they came
  std::optional<Witnessed> ahead_;                ///< without delay, until it has told the lag
  std::optional<double> first_lag_s_;
  Witnessed followed_;
  std::optional<Timestamp> last_;  ///< that was handed on
  Pose2 start_from_robot_;
};

}  // namespace deltamap::surveying::slam
