// SPDX-License-Identifier: Apache-2.0
// A second witness of the robot's motion beside its wheels: each scan is held against what the last metres have seen,
// with the wheels as a prior that is not trusted blindly. Wheels that slip or spin contradict it; along a bare corridor
// it knows nothing, and the wheels rule by themselves. Filtered is the pose in the map of the last metres, not the
// motion of a step: small steps would follow the wheels else (docs/decisions/laser-odometer.md).
#pragma once

#include <cstdint>
#include <deque>
#include <optional>
#include <span>

#include "core/messages.hpp"
#include "localization/odometer/line_points.hpp"
#include "localization/odometer/scan_fit.hpp"
#include "localization/odometer/standstill.hpp"
#include "localization/odometer/surfel_map.hpp"

namespace deltamap::localization::odometer {

/// What the wheels tell of one scan.
struct WheelsAt {
  Pose2 odom_from_robot;
  std::uint32_t epoch = 0;
};

/// One scan's answer, about the motion since the scan before; covariances in the frame of the pose before.
struct LaserMotion {
  Pose2 motion;  ///< what is believed: wheels and laser together
  PoseCovariance covariance = PoseCovariance::Zero();
  Pose2 by_laser;  ///< by the scans alone
  PoseCovariance laser_covariance = PoseCovariance::Zero();
  /// Of the pose among what the last metres have shown, in the robot's frame; and what is left in its error of the
  /// error of the pose before. Errors are (x, y, θ), each in the robot's frame at its time.
  PoseCovariance deviation = PoseCovariance::Zero();
  Eigen::Matrix3d kept = Eigen::Matrix3d::Identity();
  double disagreement = 0.0;  ///< squared deviations between wheels and scans, of the step or of the last 1.5 s
  bool contradicts = false;   ///< the wheels are wrong
  /// Where it contradicts, and for a while after that, for what wheels have left out they may bring later: where the
  /// robot is, seen from where the wheels have it.
  std::optional<Pose2> slip;
  double stood_m = 0.0;  ///< way that the wheels have claimed while the robot stands; turns count 0.3 m a radian
  bool is_lost = false;  ///< the scan fits nowhere: the wheels alone
  double inliers = 0.0;  ///< share of the points on lines that lie on what was seen before
};

class LaserOdometer {
 public:
  /// One more scan, `rays` freed of the robot's own motion; without wheels nothing speaks against the laser. Where the
  /// answer has a slip, the wheels' next pose is to be given with it: odom_from_robot * slip.
  /// `leads`: nothing else tells of the pose, so the answer takes the wheels' place at each scan.
  [[nodiscard]] LaserMotion observe(const Scan& scan, std::span<const RayInRobot> rays,
                                    const std::optional<WheelsAt>& wheels, bool leads = false);

  /// In its own frame, from the first scan on.
  [[nodiscard]] const Pose2& start_from_robot() const { return pose_; }

 private:
  /// What the wheels count from one scan to the next, or what the robot did before where they tell nothing.
  struct Step {
    Pose2 motion;
    bool by_wheels = false;
    double driven_m = 0.0;
    double turned_rad = 0.0;
    double passed_s = 0.0;
    [[nodiscard]] double way_m() const;
  };
  /// A scan of the last 1.5 s.
  struct Compared {
    double time_s = 0.0;
    Pose2 start_from_laser;  // by the scan alone
    Pose2 start_from_robot;  // believed
    Pose2 wheels;            // summed up
  };
  /// At the scan that others are held against to tell whether the robot stands.
  struct Anchor {
    Pose2 start_from_robot;
    PoseCovariance deviation = PoseCovariance::Zero();
    double time_s = 0.0;
    Pose2 claimed;      // by the wheels since the scan that is kept
    double odds = 0.0;  // of standing, nats, by the scans that were kept before that one
  };

  [[nodiscard]] Step step_to(Timestamp time, const std::optional<WheelsAt>& wheels);
  [[nodiscard]] bool stands_still(const Scan& scan, std::span<const RayInRobot> rays, const Step& step);
  /// Of a robot that has stood since the anchor, nats, over all kept scans.
  [[nodiscard]] double odds_of_standing() const { return anchor_.odds + standing_odds_; }
  void stand(LaserMotion& answer, const Step& step);
  void anchor(const Scan& scan, std::span<const RayInRobot> rays);
  void go_on_standing(const Scan& scan, std::span<const RayInRobot> rays);
  [[nodiscard]] ScanFit fit(std::span<const LinePoint> points, const Pose2& predicted, const Step& step) const;
  [[nodiscard]] bool fits_nowhere(const ScanFit& fitted, const Step& step) const;
  [[nodiscard]] Compared compare(const ScanFit& fitted, const Step& step, LaserMotion& answer) const;
  void believe(const ScanFit& fitted, const Step& step, LaserMotion& answer);
  void correct_wheels(const Pose2& slip, LaserMotion& answer);
  void lead(const Step& step, LaserMotion& answer);
  void remember(std::span<const LinePoint> points, const LaserMotion& answer);

  LinePointFinder finder_;
  SurfelMap map_;
  Pose2 pose_;                                         // believed, start frame
  PoseCovariance deviation_ = PoseCovariance::Zero();  // of the pose in the map of the last metres
  std::optional<Timestamp> last_;
  std::optional<WheelsAt> last_wheels_;
  Pose2 last_motion_;
  double last_step_s_ = 0.0;
  double way_m_ = 0.0;
  double time_s_ = 0.0;
  double usual_inliers_ = 0.0;
  int lost_in_a_row_ = 0;
  Pose2 inserted_at_;
  int inserted_standing_ = 0;

  std::deque<Compared> compared_;
  Pose2 wheels_;  // summed up
  double distrusted_until_s_ = -1.0;

  Standstill standstill_;
  Anchor anchor_;
  double standing_odds_ = Standstill::kClearlyMoved;  // of the newest scan beside the kept one
  bool stands_ = false;                               // though its wheels turn
  double stood_m_ = 0.0;                              // claimed meanwhile
};

}  // namespace deltamap::localization::odometer
