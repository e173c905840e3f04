// SPDX-License-Identifier: Apache-2.0
// The part of the daemon that drives, in virtual time: the robot's session and its link, the kept drive switch, safety
// and a pilot. Killed and started again like a process; its robot is whatever answers like simulation::Simulation.
#pragma once

#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "daemon/kept/kept_drive.hpp"
#include "drivers/lms200/session.hpp"
#include "drivers/pioneer/session.hpp"
#include "drivers/port/reconnect.hpp"
#include "navigation/safety.hpp"
#include "navigation/wander.hpp"

namespace deltamap::test {

/// One session on one line: what DeviceLink does with a port.
template <typename Session>
class VirtualLink {
 public:
  using Write = std::function<void(std::span<const std::uint8_t>, unsigned baud)>;
  VirtualLink(Session session, Write write) : session_{std::move(session)}, write_{std::move(write)} {}

  template <typename Output>
  void obey(const Output& out, Timestamp now) {
    if (!is_open()) return;  // no port to write to, as in DeviceLink
    for (const drivers::PortRequest& request : out.output.requests) {
      if (request.kind == drivers::PortRequest::Kind::kWrite) write_(request.bytes, baud_);
      if (request.kind == drivers::PortRequest::Kind::kSetBaud) baud_ = request.baud;
    }
    wake_at_ = out.output.wake_at;
    if (!out.output.failed) return;
    wake_at_.reset();
    try_again_at_ = reconnect_.failed(*out.output.failed, now).try_again_at;
  }
  /// A port that hangs up, as an adapter that is pulled out.
  void hang_up(Timestamp now) {
    wake_at_.reset();
    try_again_at_ = reconnect_.failed("the device hung up", now).try_again_at;
  }
  /// Answers what the session made of the bytes and of the time.
  template <typename Take>
  void turn(std::span<const std::uint8_t> bytes, bool can_open, Timestamp now, const Take& take) {
    if (try_again_at_) {
      if (now < *try_again_at_) return;
      if (!can_open) return hang_up(now);
      try_again_at_.reset();
      reconnect_.opened();
      return obey(session_.start(now), now);
    }
    if (!bytes.empty()) {
      auto out = session_.on_bytes(bytes, now);
      obey(out, now);
      take(out);
    }
    if (wake_at_ && *wake_at_ <= now) {
      auto out = session_.on_time(now);
      obey(out, now);
      take(out);
    }
  }
  [[nodiscard]] Session& session() { return session_; }
  [[nodiscard]] unsigned baud() const { return baud_; }
  [[nodiscard]] bool is_open() const { return !try_again_at_; }

 private:
  Session session_;
  Write write_;
  unsigned baud_ = 9600;
  std::optional<Timestamp> wake_at_;
  std::optional<Timestamp> try_again_at_;
  drivers::port::Reconnect reconnect_{drivers::port::ReconnectParams{}};
};

/// Devices: now(), advance_to(), next_event(), send_to_robot(), bytes_from_robot(), and the same of a laser.
template <typename Devices>
class DrivingDaemon {
 public:
  using PioneerSession = drivers::pioneer::PioneerSession;
  using Lms200Session = drivers::lms200::Lms200Session;

  struct Params {
    drivers::pioneer::PioneerParams robot;
    drivers::lms200::Lms200Params laser;
    navigation::SafetyParams safety;
    navigation::WanderParams wander;
    std::filesystem::path kept_file;
    std::uint64_t seed = 1;
    std::function<DriveCommand(const Scan&)> pilot{};  ///< in place of wandering
  };

  DrivingDaemon(Devices& devices, Params params) : devices_{devices}, params_{std::move(params)} {
    params_.robot.enable_motors = true;
  }

  void start() {
    process_.emplace(*this);
    const Timestamp now = devices_.now();
    process_->robot.obey(process_->robot.session().start(now), now);
    process_->laser.obey(process_->laser.session().start(now), now);
  }
  void kill() { process_.reset(); }
  [[nodiscard]] bool is_alive() const { return process_.has_value(); }
  /// The robot's line carries nothing in either direction.
  void cut_line(bool is_cut) { line_is_cut_ = is_cut; }
  /// Half a cable: the robot hears us, we do not hear it.
  void cut_answers(bool are_cut) { answers_are_cut_ = are_cut; }
  /// The adapter is pulled out: the port hangs up and cannot be opened.
  void pull_adapter(bool is_out) {
    adapter_is_out_ = is_out;
    if (is_out && process_ && process_->robot.is_open()) process_->robot.hang_up(devices_.now());
  }
  [[nodiscard]] bool operator_says(bool on) {
    if (!process_ || (on && process_->robot.session().stop_button_is_pressed())) return false;
    process_->robot.obey(process_->robot.session().switch_drive(on, devices_.now()), devices_.now());
    if (on) process_->safety.let_drive_again();
    process_->obey_permission(devices_.now());
    return true;
  }

  [[nodiscard]] bool is_connected() {
    return process_ && process_->robot.is_open() && process_->robot.session().is_connected();
  }
  [[nodiscard]] Timestamp last_odometry() const { return last_odometry_; }
  [[nodiscard]] const navigation::AllowedMotion& last_allowed() const { return last_allowed_; }
  [[nodiscard]] const std::optional<Scan>& last_scan() const { return last_scan_; }
  [[nodiscard]] const std::vector<std::string>& log() const { return log_; }

  void run(
      double duration_s, const std::function<void()>& each_step = [] {}) {
    for (const Timestamp end = devices_.now() + duration_from_seconds(duration_s); devices_.now() < end;) {
      devices_.advance_to(std::min(end, devices_.next_event()));
      turn();
      each_step();
    }
  }

 private:
  /// What dies with it.
  struct Process {
    explicit Process(DrivingDaemon& owner)
        : kept{{owner.params_.kept_file, "/dev/robot"}},
          safety{owner.params_.safety},
          pilot{owner.params_.wander, owner.params_.seed},
          robot{PioneerSession{owner.robot_params(kept), drivers::SessionMode::kLive},
                [&owner](std::span<const std::uint8_t> bytes, unsigned baud) { owner.write_to_robot(bytes, baud); }},
          laser{Lms200Session{owner.params_.laser, drivers::SessionMode::kLive},
                [&owner](std::span<const std::uint8_t> bytes, unsigned baud) {
                  owner.devices_.send_to_laser(bytes, baud);
                }} {}

    void obey_permission(Timestamp now) {
      const auto& permission = robot.session().permission();
      if (!permission.holds()) safety.release();
      (void)kept.keep(daemon::switch_to_keep(permission.drive_switch(), safety.waits_for()), now);
    }

    daemon::KeptDrive kept;
    navigation::Safety safety;
    navigation::Wander pilot;
    VirtualLink<PioneerSession> robot;
    VirtualLink<Lms200Session> laser;
    Odometry odometry;
    Timestamp next_safety{};
  };

  [[nodiscard]] drivers::pioneer::PioneerParams robot_params(const daemon::KeptDrive& kept) const {
    auto params = params_.robot;
    params.drive_switch = kept.value();
    return params;
  }
  void write_to_robot(std::span<const std::uint8_t> bytes, unsigned baud) {
    if (!line_is_cut_ && !adapter_is_out_) devices_.send_to_robot(bytes, baud);
  }

  void turn() {
    const unsigned robot_baud = process_ ? process_->robot.baud() : 9600;
    const unsigned laser_baud = process_ ? process_->laser.baud() : 9600;
    std::vector<std::uint8_t> from_robot = devices_.bytes_from_robot(robot_baud);
    const std::vector<std::uint8_t> from_laser = devices_.bytes_from_laser(laser_baud);
    if (!process_) return;
    if (line_is_cut_ || answers_are_cut_ || adapter_is_out_) from_robot.clear();
    const Timestamp now = devices_.now();
    process_->robot.turn(from_robot, !adapter_is_out_, now, [&](auto& out) { take(out, now); });
    process_->laser.turn(from_laser, true, now, [&](auto& out) { take(out, now); });
    drive(now);
  }

  void take(const drivers::pioneer::PioneerOutput& out, Timestamp now) {
    for (const Odometry& odometry : out.odometry) {
      process_->safety.observe(odometry);
      process_->odometry = odometry;
      last_odometry_ = now;
    }
    log_.insert(log_.end(), out.output.log.begin(), out.output.log.end());
    process_->obey_permission(now);
  }

  void take(const drivers::lms200::Lms200Output& out, Timestamp now) {
    for (const Scan& scan : out.scans) {
      process_->safety.set_nominal_scan_period(process_->laser.session().nominal_period_s());
      process_->safety.observe(scan);
      last_scan_ = scan;
      TrackedScan tracked;
      tracked.scan = scan;
      tracked.odom_from_robot = process_->odometry.odom_from_robot;
      tracked.odometry_epoch = process_->odometry.epoch;
      const DriveCommand wish = params_.pilot ? params_.pilot(scan) : process_->pilot.step(tracked);
      if (process_->robot.session().permission().holds()) process_->safety.command(wish, now);
    }
  }

  void drive(Timestamp now) {
    if (now < process_->next_safety || !is_connected()) return;
    process_->next_safety = now + std::chrono::milliseconds{50};
    PioneerSession& robot = process_->robot.session();
    const auto limits = robot.stopping_limits();
    process_->safety.set_stopping_behaviour(
        {limits.watchdog_s, limits.deceleration_m_per_s2, limits.turn_deceleration_rad_per_s2});
    const navigation::AllowedMotion motion = last_allowed_ = process_->safety.allowed(now);
    process_->robot.obey(motion.brake_hard ? robot.emergency_stop(now)
                                           : robot.drive({now, motion.speed_m_per_s, motion.turn_rate_rad_per_s}, now),
                         now);
  }

  Devices& devices_;
  Params params_;
  std::optional<Process> process_;
  bool line_is_cut_ = false;
  bool answers_are_cut_ = false;
  bool adapter_is_out_ = false;
  Timestamp last_odometry_{};
  std::optional<Scan> last_scan_;
  navigation::AllowedMotion last_allowed_;
  std::vector<std::string> log_;
};

}  // namespace deltamap::test
