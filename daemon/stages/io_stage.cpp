// SPDX-License-Identifier: Apache-2.0
#include "daemon/stages/io_stage.hpp"

#include <boost/asio/post.hpp>
#include <chrono>

#include "daemon/kept/kept_drive.hpp"
#include "daemon/telemetry/loop_pulse.hpp"
#include "daemon/telemetry/stop_log.hpp"

namespace deltamap::daemon {
namespace {

namespace asio = boost::asio;
using drivers::lms200::Lms200Output;
using drivers::lms200::Lms200Session;
using drivers::pioneer::PioneerOutput;
using drivers::pioneer::PioneerSession;
using drivers::port::PortId;

constexpr std::chrono::milliseconds kSafetyPeriod{50};   // twice a controller cycle (protocols.md A6)
constexpr std::chrono::seconds kRequestLife{1};          // to drive: this thread has hung, or the machine
constexpr double kHandLife_s = 0.25;                     // of a command by hand: with one safety period below 0.3 s
constexpr std::chrono::milliseconds kRobotSilence{500};  // five controller cycles: it is not heard, and may not hear
constexpr std::chrono::milliseconds kFarewell{300};      // for the last packets to leave at 9600 baud

drivers::pioneer::PioneerParams robot_params(const Settings& settings, const KeptDrive& kept) {
  auto params = settings.robot.session;
  params.enable_motors = settings.navigation.mode != navigation::DriveMode::kOff;
  params.drive_switch = kept.value();
  return params;
}

/// A replay keeps nothing.
KeptDrive kept_drive(const Settings& settings, drivers::SessionMode mode) {
  return KeptDrive{mode == drivers::SessionMode::kLive ? drive_place(settings.map.store, settings.robot.port)
                                                       : DrivePlace{}};
}

PortOpener serial_opener(const Settings& settings) {
  return [robot = settings.robot.port, laser = settings.laser.port](asio::io_context& loop, PortId id, unsigned baud) {
    return drivers::port::open_serial_port(loop, id == PortId::kRobot ? robot : laser, baud);
  };
}

struct DriveRequest {
  bool may_drive;
  std::uint64_t ticket;
  Timestamp asked;
};

}  // namespace

struct IoStage::State {
  State(const Settings& settings, Wiring given)
      : wiring{std::move(given)},
        drives{settings.navigation.mode != navigation::DriveMode::kOff},
        kept{kept_drive(settings, wiring.mode)},
        safety{settings.navigation.safety},
        safety_timer{loop},
        robot{loop,
              PortId::kRobot,
              PioneerSession{robot_params(settings, kept), wiring.mode},
              {opener(settings), recorder(), [this](PioneerOutput& out) { take(out); },
               [this] { wiring.telemetry.robot_up.set(false); }, wiring.log, wiring.warn}},
        laser{loop,
              PortId::kLaser,
              Lms200Session{settings.laser.session, wiring.mode},
              {opener(settings), recorder(), [this](Lms200Output& out) { take(out); },
               [this] { wiring.telemetry.laser_up.set(false); }, wiring.log, wiring.warn}} {
    if (drives && !kept.why_unknown().empty()) wiring.warn(kept.why_unknown());
    show(navigation::StopReason::kNoCommand, {});
    obey_permission();
  }

  [[nodiscard]] PortOpener opener(const Settings& settings) {
    return wiring.open ? wiring.open : serial_opener(settings);
  }

  [[nodiscard]] drivers::port::RecordSink recorder() {
    return [this](drivers::port::ByteRecord&& record) {
      if (!wiring.recorder.send(std::move(record))) wiring.telemetry.recording_lost.add(1);
    };
  }

  /// A session whose port is gone still holds what it knew.
  [[nodiscard]] bool robot_is_connected() const { return robot.is_open() && robot.session().is_connected(); }

  void take(PioneerOutput& out) {
    Telemetry& telemetry = wiring.telemetry;
    if (!out.odometry.empty()) robot_heard_at = drivers::port::port_clock_now();
    for (Odometry& odometry : out.odometry) {
      safety.observe(odometry);
      telemetry.battery_v.set(odometry.battery_v);
      const auto number = static_cast<std::uint32_t>(telemetry.odometry.value());
      telemetry.odometry.add(1);
      if (wiring.sensors.try_send(std::move(odometry))) continue;
      telemetry.odometry_lost.add(1);
      note({Decision::Kind::kOdometryLost, 0, number});
    }
    const bool up = robot_is_connected();
    if (up && !telemetry.robot_up.value()) robot.tell_connected();
    telemetry.robot_up.set(up);
    telemetry.never_driven.set(robot.session().why_never_driven());
    obey_permission();
  }

  /// Who may drive is the session's to say (drive_permission): it hears the buttons. What it says is kept and obeyed.
  void obey_permission() {
    const drivers::pioneer::DrivePermission& permission = robot.session().permission();
    if (!permission.holds()) safety.release();
    wiring.telemetry.drives.set(permission.holds());
    wiring.telemetry.drive_switch.set(static_cast<std::uint8_t>(permission.drive_switch()));
    keep_switch();
  }

  void keep_switch() {
    const auto value = in_hand_of != 0
                           ? drivers::pioneer::DriveSwitch::kOffByOperator
                           : switch_to_keep(robot.session().permission().drive_switch(), safety.waits_for());
    const std::string line = kept.keep(value, drivers::port::port_clock_now());
    if (!line.empty()) (kept.why_not_kept().empty() ? wiring.log : wiring.warn)(line);
  }

  void take(Lms200Output& out) {
    Telemetry& telemetry = wiring.telemetry;
    for (Scan& scan : out.scans) {
      scan.number = static_cast<std::uint32_t>(telemetry.scans.value());
      const std::uint32_t number = scan.number;
      safety.observe(scan);
      telemetry.scans.add(1);
      if (wiring.sensors.try_send(std::move(scan))) continue;
      telemetry.scans_lost.add(1);
      note({Decision::Kind::kScanLost, number, 0});
    }
    const bool up = laser.is_open() && laser.session().is_streaming();
    if (up && !telemetry.laser_up.value()) {
      laser.tell_connected();
      safety.set_nominal_scan_period(laser.session().nominal_period_s());
    }
    telemetry.laser_up.set(up);
  }

  void note(const Decision& decision) {
    if (!wiring.recorder.send(note_of(decision))) wiring.telemetry.recording_lost.add(1);
  }

  void watch_over_motion() {
    safety_timer.expires_after(kSafetyPeriod);
    safety_timer.async_wait([this](const boost::system::error_code& error) {
      if (error) return;
      keep_switch();  // what stops it may be the laser; what could not be written is tried again
      send_allowed_motion();
      watch_over_motion();
    });
  }

  void send_allowed_motion() {
    const Timestamp now = drivers::port::port_clock_now();
    if (!robot_is_connected()) return show(safety.allowed(now).stop, {});
    if (in_hand_of != 0 && seconds(now - hand_moved) > kHandLife_s) safety.release();
    const auto limits = robot.session().stopping_limits();
    safety.set_stopping_behaviour(
        {limits.watchdog_s, limits.deceleration_m_per_s2, limits.turn_deceleration_rad_per_s2});
    const navigation::AllowedMotion motion = safety.allowed(now);
    if (const LogLine line = stop_log.line(motion.stop); !line.text.empty()) {
      (line.is_warning ? wiring.warn : wiring.log)(line.text);
    }
    show(motion.stop, motion.brake_hard ? Told{} : Told{motion.speed_m_per_s, motion.turn_rate_rad_per_s});
    if (motion.brake_hard) return robot.handle(robot.session().emergency_stop(now));
    robot.handle(robot.session().drive({now, motion.speed_m_per_s, motion.turn_rate_rad_per_s}, now));
  }

  struct Told {
    double speed_m_per_s = 0.0;
    double turn_rate_rad_per_s = 0.0;
  };
  void show(navigation::StopReason stop, const Told& told) {
    wiring.telemetry.stop_reason.set(static_cast<std::uint8_t>(stop));
    wiring.telemetry.told_speed_m_per_s.set(told.speed_m_per_s);
    wiring.telemetry.told_turn_rate_rad_per_s.set(told.turn_rate_rad_per_s);
  }

  control::CommandOutcome let_drive(const DriveRequest& request) {
    const Timestamp now = drivers::port::port_clock_now();
    if (request.may_drive && in_hand_of != 0)
      return {request.ticket, false, "it is driven by hand: that must end first"};
    if (!request.may_drive) put_in_hand_of(0);
    return request.may_drive ? switch_on(request, now) : switch_off(request.ticket, now);
  }

  void put_in_hand_of(std::uint64_t who) {
    if (in_hand_of == who) return;
    in_hand_of = who;
    wiring.log(who != 0 ? "drive: taken by hand" : "drive: let go by hand");
    wiring.telemetry.by_hand.set(who != 0);
    safety.release();
  }

  control::CommandOutcome take_by_hand(std::uint64_t who, Timestamp asked) {
    if (!drives) return {who, false, "'navigation.mode' is off: this daemon never drives"};
    if (in_hand_of != 0) return {who, false, "somebody else drives it by hand"};
    put_in_hand_of(who);
    keep_switch();  // off, before the motors come on: a restart is no hand
    const std::string& why = kept.why_not_kept();
    const control::CommandOutcome outcome =
        why.empty() ? switch_on({true, who, asked}, drivers::port::port_clock_now())
                    : control::CommandOutcome{who, false, "that the pilot stays off cannot be kept on disk: " + why};
    if (!outcome.done) put_in_hand_of(0);
    return outcome;
  }

  void drive_by_hand(std::uint64_t who, const DriveCommand& command) {
    if (in_hand_of != who || command.time < hand_moved || !robot.session().permission().holds()) return;
    hand_moved = command.time;
    safety.command(command, command.time);
  }

  void let_go(std::uint64_t who) {
    if (in_hand_of == who) (void)let_drive({false, who, {}});
  }

  /// Refused as long as anything speaks against it: a refusal must not drive later, by itself.
  control::CommandOutcome switch_on(const DriveRequest& request, Timestamp now) {
    if (now - request.asked > kRequestLife) {
      return {request.ticket, false, "it was asked for too long ago: say so again"};
    }
    if (robot.session().stop_button_is_pressed()) {
      return {request.ticket, false, "the STOP button is pressed: let it go first"};
    }
    safety.let_drive_again();
    if (const navigation::StopReason held_by = safety.waits_for(); held_by != navigation::StopReason::kNone) {
      return {request.ticket, false,
              "it stands: " + std::string(name_of(held_by)) + "; say so again when that is over"};
    }
    if (const std::string_view why = robot.session().why_never_driven(); !why.empty()) {
      return {request.ticket, false, "it is not driven: " + std::string(why)};
    }
    robot.handle(robot.session().switch_drive(true, now));
    return {request.ticket, true, when_it_drives()};
  }

  [[nodiscard]] std::string when_it_drives() const {
    if (!robot_is_connected()) return "wanders once the robot is connected";
    if (!robot.session().stopping_limits().watchdog_s) return "wanders once the robot has told its watchdog";
    return "wanders from the next scan on";
  }

  control::CommandOutcome switch_off(std::uint64_t ticket, Timestamp now) {
    robot.handle(robot.session().switch_drive(false, now));
    if (drives) send_allowed_motion();
    const bool is_told = !drives || (robot_is_connected() && now - robot_heard_at < kRobotSilence);
    const std::string told = is_told
                                 ? "the robot is told to stand"
                                 : "the robot cannot be told now: what moves goes on until its watchdog; press STOP";
    if (const std::string& why = kept.why_not_kept(); !why.empty()) {
      return {ticket, false, told + ". The off is NOT kept on disk: " + why};
    }
    return {ticket, is_told, is_told ? told : "kept, but " + told};
  }

  void take(const DriveCommand& command, navigation::StopReason held_by) {
    if (in_hand_of != 0 || !robot.session().permission().holds()) return;
    safety.command(command, drivers::port::port_clock_now(), held_by);
  }

  void close() {
    safety_timer.cancel();
    robot.close();
    laser.close();
    await_farewell();
  }

  void await_farewell() {
    const bool was_leaving = robot.is_open() && robot.session().is_leaving();
    farewell_timer.expires_after(kFarewell);
    farewell_timer.async_wait(
        [this, was_leaving](const boost::system::error_code&) { was_leaving ? await_farewell() : loop.stop(); });
  }

  asio::io_context loop{1};
  LoopPulse pulse;
  Wiring wiring;
  bool drives;                   // by the settings
  std::uint64_t in_hand_of = 0;  // nobody else's commands are listened to; 0: in nobody's
  Timestamp hand_moved{};        // of the newest command by hand
  Timestamp robot_heard_at{};
  KeptDrive kept;
  navigation::Safety safety;
  StopLog stop_log;
  asio::steady_timer safety_timer;
  asio::steady_timer farewell_timer{loop};
  DeviceLink<PioneerSession, PioneerOutput> robot;
  DeviceLink<Lms200Session, Lms200Output> laser;
};

IoStage::IoStage(const Settings& settings, Wiring wiring)
    : state_{std::make_unique<State>(settings, std::move(wiring))} {}
IoStage::~IoStage() = default;

void IoStage::run() {
  const auto keep_alive = asio::make_work_guard(state_->loop);
  state_->robot.open();
  state_->laser.open();
  if (state_->drives) state_->watch_over_motion();
  state_->loop.run();
}

void IoStage::stop() {
  asio::post(state_->loop, [this] { state_->close(); });
}

void IoStage::post(const DriveCommand& command, navigation::StopReason held_by) {
  asio::post(state_->loop, [state = state_.get(), command, held_by] { state->take(command, held_by); });
}

void IoStage::let_drive(bool may_drive, std::uint64_t ticket) {
  const DriveRequest request{may_drive, ticket, drivers::port::port_clock_now()};
  asio::post(state_->loop, [state = state_.get(), request] {
    const control::CommandOutcome outcome = state->let_drive(request);
    if (state->wiring.answer) state->wiring.answer(outcome);
  });
}

void IoStage::take_by_hand(std::uint64_t who, std::function<void(const control::CommandOutcome&)> answer) {
  asio::post(state_->loop, [state = state_.get(), who, asked = drivers::port::port_clock_now(),
                            answer = std::move(answer)] { answer(state->take_by_hand(who, asked)); });
}

void IoStage::drive_by_hand(std::uint64_t who, const DriveCommand& command) {
  asio::post(state_->loop, [state = state_.get(), who, command] { state->drive_by_hand(who, command); });
}

void IoStage::let_go(std::uint64_t who) {
  asio::post(state_->loop, [state = state_.get(), who] { state->let_go(who); });
}

void IoStage::set_safety(const navigation::SafetyParams& params) {
  asio::post(state_->loop, [state = state_.get(), params] { state->safety.set_params(params); });
}

double IoStage::silence_s() const {
  return state_->pulse.silence_s([this](auto work) { asio::post(state_->loop, std::move(work)); });
}

std::map<std::string, std::uint64_t> IoStage::counts() const {
  std::map<std::string, std::uint64_t> all;
  add_counts(all, "robot", state_->robot.session().counts());
  add_counts(all, "laser", state_->laser.session().counts());
  return all;
}

}  // namespace deltamap::daemon
