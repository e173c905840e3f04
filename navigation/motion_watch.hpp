// SPDX-License-Identifier: Apache-2.0
// Do the scans follow the wheels? Two scans some way apart are held against what the wheels tell of it. A laser that
// looks another way than its mount says sees the way ahead where no beam is: until the scans have once shown a
// translation that the wheels tell, nothing proves that it looks ahead. A turn proves nothing: turned round, it sees
// the same turn. Two scans that have nothing in common put it in doubt again: the laser itself may have been turned.
#pragma once

#include <cstdint>
#include <optional>

#include "core/messages.hpp"
#include "navigation/shown_motion.hpp"

namespace deltamap::navigation {

class MotionWatch {
 public:
  /// `epoch`: of the odometry; poses of two cannot be compared.
  void observe(const Scan& scan, const Pose2& odom_from_robot, std::uint32_t epoch);
  /// This scan tells nothing, or it is not known where the wheels were.
  void skip();

  /// The wheels say that the robot moves, and what it sees stands still or moves another way.
  [[nodiscard]] bool contradicts_wheels() const;
  /// In this odometry epoch, with this mount and without a long silence of the laser the scans have followed a
  /// translation; or a metre has shown nothing that could be asked.
  [[nodiscard]] bool looks_ahead() const { return looks_ahead_; }
  /// A person said drive. Whether the laser looks ahead is to be shown again.
  void forget_contradiction();

 private:
  /// What of a scan the next one is asked for.
  struct Moment {
    Timestamp time;
    Pose2 robot_from_laser;
    Pose2 odom_from_robot;
    std::uint32_t epoch;
  };
  struct Reference {
    Scan scan;
    Pose2 odom_from_robot;
    bool creeps;  // from then on
  };
  [[nodiscard]] bool goes_on(const Moment& now) const;
  void doubt();
  void judge(const ShownMotion& shown, double least_more);
  [[nodiscard]] bool is_slow(const Moment& now) const;
  void compare(const Scan& scan, const Pose2& odom_from_robot);

  std::optional<Reference> reference_;  // what later scans are held against
  double judged_m_ = 0.0;               // of the way from there
  std::optional<Moment> last_;
  int contradictions_ = 0;  // unbroken
  bool looks_ahead_ = false;
  double unproven_m_ = 0.0;  // driven since that is in doubt
};

}  // namespace deltamap::navigation
