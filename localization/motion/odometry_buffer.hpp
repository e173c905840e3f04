// SPDX-License-Identifier: Apache-2.0
// Remembers the last odometry and answers where the wheels say the robot was at any beam's time: interpolated between
// two reports, extrapolated a little past the newest, never waiting (docs/frames_and_units.md).
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "core/geometry/angle.hpp"
#include "core/messages.hpp"
#include "localization/motion/drive_calibration.hpp"
#include "localization/motion/motion_variance.hpp"

namespace deltamap::localization::motion {

struct OdometryBufferParams {
  int capacity = 512;                               ///< reports remembered; 2..65536
  double extrapolation_s = 0.15;                    ///< longest reach past the newest report, s; >= 0
  double max_speed_m_per_s = 1.5;                   ///< of the robot: faster readings are clamped, m/s; > 0
  double max_turn_rate_rad_per_s = radians(300.0);  ///< of the robot: faster readings are clamped, rad/s; > 0
};

struct BodyVelocity {
  double speed_m_per_s = 0.0;        ///< forward
  double turn_rate_rad_per_s = 0.0;  ///< counter-clockwise
};

/// The wheels' answer for one instant.
struct OdometryAt {
  Pose2 odom_from_robot;  ///< in the frame of `epoch`
  std::uint32_t epoch = 0;
  Pose2 continuous_odom_from_robot;  ///< in one frame over all epochs, without what is known of the wheels' systematic
                                     ///< errors; the jump between two epochs counts as standing still
  MotionVariance slipped{};          ///< what corrections by the scans have left open up to then: it only grows
  double uncovered_s = 0.0;          ///< seconds between the instant and the nearest report that could speak for it
  /// From then up to the instant scans have told the motion, not the wheels; nothing where wheels tell it.
  std::optional<Timestamp> led_since{};
};

class OdometryBuffer {
 public:
  explicit OdometryBuffer(const OdometryBufferParams& params);

  /// Reports must come in order of time; one that is not newer than the last is left out, unless the clock fell back by
  /// more than a second: then the past is forgotten. One that is no number is left out.
  void add(const Odometry& odometry);

  /// What is known of the wheels: from the next report on.
  void calibrate(const WheelErrors& errors) { errors_ = errors; }

  /// How much too late the wheels' stamps are, s; takes the place of WheelErrors::lag_s.
  void set_lag(double lag_s) { lag_s_ = lag_s; }

  /// The scans contradict the wheels: at this time the robot is elsewhere than they tell, by `slip`, seen from where
  /// they have it, and as unsure as `variance`. Holds from the last report before it on.
  void correct(Timestamp time, const Pose2& slip, const MotionVariance& variance);

  /// Between two scans that follow each other the wheels have been corrected to what the scans tell.
  void led_by_scans(Timestamp from, Timestamp to);

  /// A scan is older than the one before it: unless the reports have fallen back already, nothing is known until the
  /// next one comes, which goes on from where the last one was.
  void clock_fell_back(Timestamp last_scan);

  /// Nothing before the first report.
  [[nodiscard]] std::optional<OdometryAt> at(Timestamp time) const;

  /// Of the newest report.
  [[nodiscard]] std::optional<Timestamp> newest_time() const {
    return count_ == 0 ? std::nullopt : std::optional{newest().time};
  }
  /// As the reports tell it, their lag included; nothing where they do not reach, or their epoch has changed.
  [[nodiscard]] std::optional<double> turned_between(Timestamp from, Timestamp to) const;

  /// Measured over a tenth of a second around the instant, clamped to what the robot can do.
  [[nodiscard]] BodyVelocity velocity_at(Timestamp time) const;

 private:
  struct Report {
    Timestamp time;
    Pose2 odom_from_robot;
    Pose2 continuous_odom_from_robot;
    std::uint32_t epoch = 0;
    BodyVelocity reported;
    MotionVariance slipped;
  };
  /// 0 is the oldest.
  [[nodiscard]] const Report& report(std::size_t age_order) const { return ring_[(first_ + age_order) % ring_.size()]; }
  [[nodiscard]] const Report& newest() const { return report(count_ - 1); }
  void begin_anew();
  [[nodiscard]] std::size_t first_not_before(Timestamp time) const;
  /// As the reports tell it: `lag_s` behind.
  [[nodiscard]] std::optional<OdometryAt> told_at(Timestamp time) const;
  [[nodiscard]] OdometryAt extrapolated(const Report& last, double ahead_s) const;
  [[nodiscard]] BodyVelocity newest_velocity() const;
  [[nodiscard]] BodyVelocity clamped(const BodyVelocity& velocity) const;

  OdometryBufferParams params_;
  WheelErrors errors_;
  std::optional<double> lag_s_;
  MotionVariance slipped_;
  std::optional<Timestamp> led_since_;
  std::optional<Timestamp> led_until_;
  Pose2 frame_;  ///< of `odom_from_robot` as reported, in the corrected one
  std::vector<Report> ring_;
  std::size_t first_ = 0;
  std::size_t count_ = 0;
  std::optional<Report> before_restart_;  ///< the newest when the past was forgotten
};

}  // namespace deltamap::localization::motion
