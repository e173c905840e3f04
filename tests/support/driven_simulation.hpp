// SPDX-License-Identifier: Apache-2.0
// A simulated robot and its laser, driven byte for byte by both sessions, a pilot and Safety, in virtual time. The
// client can fall silent at any moment, as a killed daemon does.
#pragma once

#include <algorithm>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "drivers/lms200/session.hpp"
#include "drivers/pioneer/session.hpp"
#include "navigation/safety.hpp"
#include "simulation/simulation.hpp"

namespace deltamap::test {

class DrivenSimulation {
 public:
  using Pilot = std::function<DriveCommand(const Scan&, const Odometry&)>;

  DrivenSimulation(const simulation::Scenario& scenario, std::uint64_t seed, Pilot pilot)
      : simulation_{scenario, {.seed = seed, .start = kStart, .change_every_s = {}}},
        surfaces_{scenario.world},
        pilot_{std::move(pilot)} {
    carry_out(robot_.start(kStart));
    carry_out(laser_.start(kStart));
  }

  void run_for(double s) {
    const Timestamp end = simulation_.now() + duration_from_seconds(s);
    while (simulation_.now() < end) step();
  }
  /// Nothing is sent or listened to any more.
  void fall_silent() { is_silent_ = true; }

  [[nodiscard]] double travelled_m() const { return travelled_m_; }
  /// Of the robot's centre from what stands in the world, the least so far; 1 at most.
  [[nodiscard]] double nearest_m() const { return nearest_m_; }
  /// The greater of what was allowed last and what the wheels say.
  [[nodiscard]] double speed_m_per_s() const { return std::max(allowed_.speed_m_per_s, wheels_m_per_s_); }
  [[nodiscard]] double wheels_m_per_s() const { return wheels_m_per_s_; }
  [[nodiscard]] const navigation::AllowedMotion& allowed() const { return allowed_; }
  [[nodiscard]] navigation::Safety& safety() { return safety_; }
  [[nodiscard]] simulation::Simulation& simulation() { return simulation_; }

 private:
  static constexpr Timestamp kStart = timestamp_from_ns(1'700'000'000'000'000'000);
  static constexpr double kSafetyPeriodS = 0.05;
  static constexpr double kDecidingS = 0.01;  // from a scan's last byte to the pilot's command

  void step() {
    const Timestamp before = simulation_.now();
    const Point2 place = simulation_.map_from_robot().position();
    simulation_.advance_to(std::max(simulation_.next_event(), before + std::chrono::milliseconds{1}));
    const Timestamp now = simulation_.now();
    const double moved_m = (simulation_.map_from_robot().position() - place).norm();
    travelled_m_ += moved_m;
    wheels_m_per_s_ = moved_m / seconds(now - before);
    if (const auto nearest = surfaces_.nearest_surface(simulation_.map_from_robot().position(), nearest_m_)) {
      nearest_m_ = nearest->distance_m;
    }
    if (!is_silent_) talk(now);
  }

  void talk(Timestamp now) {
    if (const auto bytes = simulation_.bytes_from_robot(robot_baud_); !bytes.empty()) {
      carry_out(robot_.on_bytes(bytes, now));
    }
    if (const auto bytes = simulation_.bytes_from_laser(laser_baud_); !bytes.empty()) {
      carry_out(laser_.on_bytes(bytes, now));
    }
    if (robot_wake_ && now >= *robot_wake_) carry_out(robot_.on_time(now));
    if (laser_wake_ && now >= *laser_wake_) carry_out(laser_.on_time(now));
    if (decided_ && now >= decide_at_) safety_.command(*decided_, now), decided_.reset();
    if (now < next_safety_ || !robot_.is_connected()) return;
    next_safety_ = now + duration_from_seconds(kSafetyPeriodS);
    const auto limits = robot_.stopping_limits();
    safety_.set_stopping_behaviour(
        {limits.watchdog_s, limits.deceleration_m_per_s2, limits.turn_deceleration_rad_per_s2});
    allowed_ = safety_.allowed(now);
    carry_out(allowed_.brake_hard ? robot_.emergency_stop(now)
                                  : robot_.drive({now, allowed_.speed_m_per_s, allowed_.turn_rate_rad_per_s}, now));
  }

  void carry_out(drivers::pioneer::PioneerOutput out) {
    for (const Odometry& odometry : out.odometry) safety_.observe(odometry), odometry_ = odometry;
    for (const auto& request : out.output.requests) {
      if (request.kind == drivers::PortRequest::Kind::kSetBaud) robot_baud_ = request.baud;
      if (request.kind == drivers::PortRequest::Kind::kWrite) simulation_.send_to_robot(request.bytes, robot_baud_);
    }
    robot_wake_ = out.output.wake_at;
  }
  void carry_out(drivers::lms200::Lms200Output out) {
    for (const Scan& scan : out.scans) {
      safety_.observe(scan);
      if (!odometry_) continue;
      decided_ = pilot_(scan, *odometry_);
      decide_at_ = scan.received + duration_from_seconds(kDecidingS);
    }
    for (const auto& request : out.output.requests) {
      if (request.kind == drivers::PortRequest::Kind::kSetBaud) laser_baud_ = request.baud;
      if (request.kind == drivers::PortRequest::Kind::kWrite) simulation_.send_to_laser(request.bytes, laser_baud_);
    }
    laser_wake_ = out.output.wake_at;
  }

  [[nodiscard]] static drivers::pioneer::PioneerParams robot_params() {
    drivers::pioneer::PioneerParams params;
    params.fast_baud = 38400;
    params.enable_motors = true;
    params.drive_switch = drivers::pioneer::DriveSwitch::kOn;
    params.max_speed_m_per_s = 0.7;
    params.max_turn_rate_rad_per_s = radians(80.0);
    return params;
  }
  [[nodiscard]] static drivers::lms200::Lms200Params laser_params() {
    drivers::lms200::Lms200Params params;
    params.baud = 38400;
    params.variant = {180, 100};
    params.robot_from_laser = {0.021, 0.0, 0.0};
    return params;
  }

  simulation::Simulation simulation_;
  simulation::RayCaster surfaces_;
  Pilot pilot_;
  drivers::pioneer::PioneerSession robot_{robot_params(), drivers::SessionMode::kLive};
  drivers::lms200::Lms200Session laser_{laser_params(), drivers::SessionMode::kLive};
  navigation::Safety safety_{{}};
  navigation::AllowedMotion allowed_;
  std::optional<Odometry> odometry_;
  std::optional<DriveCommand> decided_;
  Timestamp decide_at_{};
  Timestamp next_safety_{};
  std::optional<Timestamp> robot_wake_;
  std::optional<Timestamp> laser_wake_;
  unsigned robot_baud_ = 9600;
  unsigned laser_baud_ = 9600;
  double travelled_m_ = 0.0;
  double wheels_m_per_s_ = 0.0;
  double nearest_m_ = 1.0;
  bool is_silent_ = false;
};

}  // namespace deltamap::test
