// SPDX-License-Identifier: Apache-2.0
// The last word before any velocity goes to the robot, spoken in the io thread: stops for an obstacle nearer than the
// stop distance, a stale laser, bumpers, a stall, the stop button, an expired command. Reads no clock and starts
// nothing by itself.
#pragma once

#include <cstdint>
#include <optional>
#include <string_view>
#include <vector>

#include "core/angle.hpp"
#include "core/messages.hpp"
#include "navigation/free_path.hpp"

namespace deltamap::navigation {

struct SafetyParams {
  double robot_radius_m = 0.26;          ///< swing circle of the P3-DX around its axle; > 0
  double margin_m = 0.08;                ///< kept between the hull and everything; >= 0
  double deceleration_m_per_s2 = 0.3;    ///< what the controller brakes with (P3-DX flash default); > 0
  double reaction_s = 0.1;               ///< from this decision to the wheels: one controller cycle; >= 0
  double command_life_s = 0.3;           ///< a command older than that is void; > 0
  double nominal_scan_period_s = 0.107;  ///< laser stale after three of these; 180/1° at 38400 (protocols.md B7); > 0
  double odometry_life_s = 0.5;          ///< five controller cycles without a packet: the link is gone; > 0
  double max_speed_m_per_s = 0.7;        ///< > 0
  double max_turn_rate_rad_per_s = radians(80.0);  ///< > 0
  ObstacleParams obstacles{};
};

enum class StopReason : std::uint8_t {
  kNone,
  kNoCommand,       ///< nobody drives
  kCommandExpired,  ///< the pilot has fallen silent
  kNoOdometry,      ///< the robot has fallen silent
  kStopButton,
  kMotorsOff,
  kBumper,
  kStalled,
  kStaleLaser,
  kReverse,  ///< backwards is where the laser does not look
  kObstacle
};
[[nodiscard]] std::string_view name_of(StopReason reason);

/// What may be sent now. Where `stop` is set, forward speed is zero; an obstacle ahead still lets the robot turn away.
struct AllowedMotion {
  double speed_m_per_s = 0.0;
  double turn_rate_rad_per_s = 0.0;
  StopReason stop = StopReason::kNone;
};

class Safety {
 public:
  explicit Safety(const SafetyParams& params) : params_{params} {}

  void observe(const Scan& scan);
  void observe(const Odometry& odometry) { odometry_ = odometry; }
  /// A command's life counts from its arrival here: at 38400 baud a scan of 0.5° is 0.22 s old when it can be decided
  /// on.
  void command(const DriveCommand& command, Timestamp now);
  /// Forgets the command: the mode went to off.
  void release() { command_.reset(); }
  /// The laser session tells what its variant and baud give.
  void set_nominal_scan_period(double period_s) { params_.nominal_scan_period_s = period_s; }

  /// Ask before every pulse.
  [[nodiscard]] AllowedMotion allowed(Timestamp now) const;

 private:
  struct SeenScan {
    Timestamp time;      // of the first beam: the obstacles' age
    Timestamp received;  // staleness
    std::vector<Point2> obstacles_in_robot;
  };
  struct HeldCommand {
    DriveCommand command;
    Timestamp received;
  };
  [[nodiscard]] StopReason blocking_state(Timestamp now) const;
  [[nodiscard]] double safe_speed(const SeenScan& scan, double speed_m_per_s, double turn_rate_rad_per_s,
                                  Timestamp now) const;

  SafetyParams params_;
  std::optional<SeenScan> scan_;
  std::optional<Odometry> odometry_;
  std::optional<HeldCommand> command_;
};

}  // namespace deltamap::navigation
