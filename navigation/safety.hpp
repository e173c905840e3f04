// SPDX-License-Identifier: Apache-2.0
// The last word before any velocity goes to the robot, spoken in the io thread. A speed is allowed only where the robot
// would come to rest within what the laser has seen free although nobody spoke to it any more from now on. Bumpers, a
// stall, faults, a low battery, a laser that cannot be believed, a robot that does not obey, an unknown pose and
// silence stop it. Reads no clock and starts nothing by itself.
#pragma once

#include <array>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "core/geometry/angle.hpp"
#include "core/messages.hpp"
#include "navigation/coasting.hpp"
#include "navigation/fan.hpp"
#include "navigation/free_path.hpp"
#include "navigation/laser_watch.hpp"
#include "navigation/lost_ends.hpp"
#include "navigation/obedience.hpp"
#include "navigation/stop_reason.hpp"
#include "navigation/zoned_driving.hpp"

namespace deltamap::navigation {

struct SafetyParams {
  double robot_radius_m = 0.26;          ///< swing circle of the P3-DX around its axle; > 0
  double margin_m = 0.08;                ///< kept between the hull and everything; >= 0
  double deceleration_m_per_s2 = 0.3;    ///< that safe speeds are computed with (P3-DX flash default); > 0
  double reaction_s = 0.1;               ///< from this decision to the wheels: one controller cycle; >= 0
  double command_life_s = 0.3;           ///< a command older than that is void; > 0
  double nominal_scan_period_s = 0.107;  ///< laser stale after three of these; 180/1° at 38400 (protocols.md B7); > 0
  double odometry_life_s = 0.5;          ///< five controller cycles without a packet: the link is gone; > 0
  double low_battery_s = 3.0;            ///< low for so long: not the sag of a motor that starts; >= 0
  double no_battery_s = 1.0;             ///< without a voltage: not one packet; >= 0
  double plausible_s = 2.0;              ///< of scans that are not flagged, before it goes on; >= 0
  double max_speed_m_per_s = 0.7;        ///< > 0
  double max_turn_rate_rad_per_s = radians(80.0);  ///< > 0
  ObstacleParams obstacles{};
};

/// What may be sent now. Where `stop` is set, forward speed is zero; an obstacle ahead still lets the robot turn away.
struct AllowedMotion {
  double speed_m_per_s = 0.0;
  double turn_rate_rad_per_s = 0.0;
  StopReason stop = StopReason::kNone;
  bool brake_hard = false;  ///< as fast as the robot can, not as gently as it is set to
};

/// A stop that outlives its cause: it holds until the cause is gone and a person has then said drive.
class StopLatch {
 public:
  constexpr explicit StopLatch(StopReason reason) : reason_{reason} {}

  void observe(bool is_present) {
    is_present_ = is_present;
    is_held_ = is_held_ || is_present;
  }
  /// A person said drive: of no effect while the cause is still there.
  void release() { is_held_ = is_present_; }

  [[nodiscard]] bool is_held() const { return is_held_; }
  [[nodiscard]] StopReason reason() const { return reason_; }

 private:
  StopReason reason_;
  bool is_present_ = false;
  bool is_held_ = false;
};

class Safety {
 public:
  explicit Safety(const SafetyParams& params) : params_{params} {}

  void observe(const Scan& scan);
  void observe(const Odometry& odometry);
  /// A command's life counts from its arrival here: at 38400 baud a scan of 0.5° is 0.22 s old when it can be decided
  /// on. `held_by`: why the pilot itself must not drive now.
  void command(const DriveCommand& command, Timestamp now, StopReason held_by = StopReason::kNone);
  /// Whoever drives: of the newest pose that holds; of one that does not, nothing.
  void heed(ZonesAround zones) { zones_ = std::move(zones); }
  /// Forgets the command: the mode went to off.
  void release() { command_.reset(); }
  /// What was sent to the robot just now: it is held to that. Nothing: nobody talks to it.
  void told(const std::optional<Motion>& motion, Timestamp now);
  /// Where the map says that the laser should see nothing, it may: as LaserWatch::excuse().
  void expect_no_range(std::optional<Timestamp> scan_time) { laser_.excuse(scan_time); }
  /// By the localizer: the wheels turn and the scans stand.
  void set_wheels_spin(bool wheels_spin) { wheels_spin_ = wheels_spin; }
  /// Whoever knows map and pose: a part of the laser never sees what the map has.
  void set_misses_walls(bool misses_walls) { misses_walls_ = misses_walls; }
  /// The robot's session does not know what hull and units this robot has.
  void set_unknown_robot(bool is_unknown) { is_unknown_robot_ = is_unknown; }
  /// A person said drive (`deltamap ctl drive wander`; Safety sees the MOTORS button itself): stops whose cause is gone
  /// end, and what the laser has ceased to see is held against it no more.
  void let_drive_again();
  [[nodiscard]] std::uint32_t times_let_drive() const { return times_let_drive_; }
  /// The last time, the laser had ceased to see something.
  [[nodiscard]] bool has_forgotten_blindness() const { return has_forgotten_blindness_; }
  /// What a person has yet to answer; kNone where nothing.
  [[nodiscard]] StopReason waits_for() const;
  /// What a person's word may end: that, or what the laser has ceased to see; kNone where nothing.
  [[nodiscard]] StopReason ends_by_word() const;
  /// It has to: until the scans have shown that the laser looks ahead.
  [[nodiscard]] bool creeps() const { return !laser_.motion().looks_ahead(); }
  /// The laser session tells what its variant and baud give.
  void set_nominal_scan_period(double period_s) { params_.nominal_scan_period_s = period_s; }
  /// In the middle of a run: from the next allowed() on. The scan period stays as the session told it.
  void set_params(SafetyParams params) {
    params.nominal_scan_period_s = params_.nominal_scan_period_s;
    params_ = params;
  }
  /// The robot's session tells what its controller has confirmed.
  void set_stopping_behaviour(const StoppingBehaviour& behaviour) { stopping_ = behaviour; }

  /// Ask before every pulse.
  [[nodiscard]] AllowedMotion allowed(Timestamp now) const;
  /// What of robot and laser forbids to drive, whoever drives and whether or not anybody wants to.
  [[nodiscard]] StopReason unfit(Timestamp now) const;

 private:
  struct SeenScan {
    Timestamp time;      // of the first beam: the obstacles' age
    Timestamp received;  // staleness
    Fan fan;
    std::vector<Point2> obstacles_in_robot;
  };
  struct HeldCommand {
    DriveCommand command;
    Timestamp received;
    StopReason held_by;
  };
  /// The first that is held is named: nothing may hide that the robot does not obey.
  enum Latched : std::size_t {
    kDisobeys,
    kBumper,
    kStalled,
    kControllerFault,
    kLowBattery,
    kLaserError,
    kWheelsSpin,
    kLatches
  };

  [[nodiscard]] StopReason blocking_state(Timestamp now) const;
  [[nodiscard]] StopReason unfit_robot(Timestamp now) const;
  [[nodiscard]] StopReason unfit_laser(Timestamp now) const;
  [[nodiscard]] std::optional<Pose2> odom_at(const Scan& scan);
  [[nodiscard]] Motion slowed(const Motion& wished) const;
  [[nodiscard]] Motion motion_now() const;
  [[nodiscard]] Coasting coasting(const Motion& at_first, const Motion& then, double blind_s) const;
  /// What it is to stay clear of, and how long it goes on as it does now from when that was so.
  struct Ground {
    std::span<const Point2> obstacles_in_robot;
    double blind_s = 0.0;
    bool is_looked_at = true;  ///< by the laser, which must see the way, too
  };
  [[nodiscard]] bool coasts_clear(const Motion& command, double radius_m, const Ground& ground) const;
  [[nodiscard]] double unseen_s(Timestamp seen, Timestamp now) const;
  [[nodiscard]] Ground scanned_ground(Timestamp now) const {
    return {scan_->obstacles_in_robot, unseen_s(scan_->time, now)};
  }
  [[nodiscard]] bool can_stop_ahead(Timestamp now) const;
  [[nodiscard]] bool must_brake_hard(Timestamp now) const;
  [[nodiscard]] double safe_share(const Motion& wished, const Ground& ground) const;
  [[nodiscard]] bool are_zones_stale(Timestamp now) const;
  [[nodiscard]] double share_before_zones(const Motion& wished, Timestamp now) const;

  SafetyParams params_;
  StoppingBehaviour stopping_;
  std::optional<SeenScan> scan_;
  std::optional<Odometry> odometry_;
  std::optional<HeldCommand> command_;
  ZonesAround zones_;
  LaserWatch laser_;
  LostEnds lost_ends_;
  std::uint32_t lost_ends_epoch_ = 0;  // of the odometry in whose frame they are
  Obedience obedience_;
  bool is_unknown_robot_ = false;
  bool misses_walls_ = false;
  bool wheels_spin_ = false;
  std::uint32_t times_let_drive_ = 0;
  bool has_forgotten_blindness_ = false;
  std::optional<Timestamp> low_battery_since_;
  std::optional<Timestamp> no_battery_since_;
  bool has_no_battery_ = false;
  std::optional<Timestamp> implausible_at_;  // the newest scan that was flagged
  bool motors_were_on_ = false;              // in this odometry epoch
  std::array<StopLatch, kLatches> latches_{StopLatch{StopReason::kDisobeys},   StopLatch{StopReason::kBumper},
                                           StopLatch{StopReason::kStalled},    StopLatch{StopReason::kControllerFault},
                                           StopLatch{StopReason::kLowBattery}, StopLatch{StopReason::kLaserError},
                                           StopLatch{StopReason::kWheelsSpin}};
};

}  // namespace deltamap::navigation
