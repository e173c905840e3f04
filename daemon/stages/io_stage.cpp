// SPDX-License-Identifier: Apache-2.0
#include "daemon/stages/io_stage.hpp"

#include <boost/asio/post.hpp>
#include <chrono>

#include "daemon/driving/drive_desk.hpp"
#include "daemon/kept/kept_drive.hpp"
#include "daemon/stages/serial_opener.hpp"
#include "daemon/telemetry/loop_pulse.hpp"

namespace deltamap::daemon {
namespace {

namespace asio = boost::asio;
using drivers::lms200::Lms200Output;
using drivers::lms200::Lms200Session;
using drivers::pioneer::PioneerOutput;
using drivers::pioneer::PioneerSession;
using drivers::port::PortId;

constexpr std::chrono::milliseconds kFarewell{300};  // for the last packets to leave at 9600 baud

drivers::pioneer::PioneerParams robot_params(const Settings& settings, const KeptDrive& kept) {
  auto params = settings.robot.session;
  params.enable_motors = settings.navigation.mode != navigation::DriveMode::kOff;
  params.drive_switch = kept.value();
  return params;
}

/// The drive switch on disk; without a file in a replay or while listening only.
KeptDrive kept_drive(const Settings& settings, drivers::SessionMode mode) {
  return KeptDrive{mode == drivers::SessionMode::kLive ? drive_place(settings.map.store, settings.robot.port)
                                                       : DrivePlace{}};
}

}  // namespace

struct IoStage::State {
  State(const Settings& settings, Wiring given)
      : wiring{std::move(given)},
        drives{settings.navigation.mode != navigation::DriveMode::kOff},
        kept{kept_drive(settings, wiring.mode)},
        drive_timer{loop},
        finder{settings.robot.port, settings.laser.port},
        robot{loop,
              PortId::kRobot,
              PioneerSession{robot_params(settings, kept), wiring.mode},
              {opener(), recorder(), [this](PioneerOutput& out) { take(out); },
               [this](const std::string& why) { lose(wiring.telemetry.robot_up, wiring.telemetry.robot_trouble, why); },
               wiring.log, wiring.warn, [this](const std::string& port) { finder.answered(PortId::kRobot, port); }}},
        laser{loop,
              PortId::kLaser,
              Lms200Session{settings.laser.session, wiring.mode},
              {opener(), recorder(), [this](Lms200Output& out) { take(out); },
               [this](const std::string& why) { lose(wiring.telemetry.laser_up, wiring.telemetry.laser_trouble, why); },
               wiring.log, wiring.warn, [this](const std::string& port) { finder.answered(PortId::kLaser, port); }}},
        drive{drives,
              settings.navigation.safety,
              {.session = robot.session(),
               .kept = kept,
               .telemetry = wiring.telemetry,
               .obey = [this](PioneerOutput out) { robot.handle(std::move(out)); },
               .log = wiring.log,
               .warn = wiring.warn}} {
    drive.obey_permission(drivers::port::port_clock_now());
  }

  [[nodiscard]] PortOpener opener() { return wiring.open ? wiring.open : serial_opener(finder); }

  [[nodiscard]] drivers::port::RecordSink recorder() {
    return [this](drivers::port::ByteRecord&& record) {
      if (!wiring.recorder.try_send(std::move(record))) wiring.telemetry.recording_lost.add(1);
    };
  }

  static void lose(Gauge<bool>& is_up, Notice& trouble, const std::string& why) {
    is_up.set(false);
    trouble.set(why);
  }

  /// Of a device that does not answer (yet), what its session said last: that the ports are swapped, for one.
  static void tell_state(bool up, Notice& trouble, const drivers::SessionOutput& out) {
    if (up) return trouble.set("");
    for (const auto* lines : {&out.log, &out.warnings}) {
      if (!lines->empty()) trouble.set(lines->back());
    }
  }

  void take(PioneerOutput& out) {
    Telemetry& telemetry = wiring.telemetry;
    const Timestamp now = drivers::port::port_clock_now();
    for (Odometry& odometry : out.odometry) {
      drive.observe(odometry, now);
      const auto number = static_cast<std::uint32_t>(telemetry.odometry.value());
      telemetry.odometry.add(1);
      if (wiring.sensors.try_send(std::move(odometry))) continue;
      telemetry.odometry_lost.add(1);
      note({Decision::Kind::kOdometryLost, 0, number});
    }
    drive.set_port_open(robot.is_open());
    const bool up = drive.robot_is_connected();
    if (up && !telemetry.robot_up.value()) robot.tell_connected();
    telemetry.robot_up.set(up);
    tell_state(up, telemetry.robot_trouble, out.output);
    drive.obey_permission(now);
  }

  void take(Lms200Output& out) {
    Telemetry& telemetry = wiring.telemetry;
    for (Scan& scan : out.scans) {
      scan.number = static_cast<std::uint32_t>(telemetry.scans.value());
      const std::uint32_t number = scan.number;
      drive.observe(scan);
      telemetry.scans.add(1);
      if (wiring.sensors.try_send(std::move(scan))) continue;
      telemetry.scans_lost.add(1);
      note({Decision::Kind::kScanLost, number, 0});
    }
    const bool up = laser.is_open() && laser.session().is_streaming();
    if (up && !telemetry.laser_up.value()) {
      laser.tell_connected();
      drive.set_nominal_scan_period(laser.session().nominal_period_s());
    }
    telemetry.laser_up.set(up);
    tell_state(up, telemetry.laser_trouble, out.output);
  }

  void note(const Decision& decision) {
    if (!wiring.recorder.try_send(note_of(decision))) wiring.telemetry.recording_lost.add(1);
  }

  void watch_over_motion() {
    drive_timer.expires_after(
        std::chrono::duration_cast<std::chrono::milliseconds>(duration_from_seconds(kSafetyPeriodS)));
    drive_timer.async_wait([this](const boost::system::error_code& error) {
      if (error) return;
      drive.set_port_open(robot.is_open());
      drive.tick(drivers::port::port_clock_now());
      watch_over_motion();
    });
  }

  void close() {
    drive_timer.cancel();
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
  bool drives;  // whether the settings allow driving
  KeptDrive kept;
  asio::steady_timer drive_timer;
  asio::steady_timer farewell_timer{loop};
  drivers::port::PortFinder finder;
  DeviceLink<PioneerSession, PioneerOutput> robot;
  DeviceLink<Lms200Session, Lms200Output> laser;
  DriveDesk drive;  // decides what the robot is told
};

IoStage::IoStage(const Settings& settings, Wiring wiring)
    : state_{std::make_unique<State>(settings, std::move(wiring))} {}
IoStage::~IoStage() = default;

void IoStage::run() {
  const auto keep_alive = asio::make_work_guard(state_->loop);
  state_->robot.open();
  state_->laser.open();
  state_->watch_over_motion();
  state_->loop.run();
}

void IoStage::stop() {
  asio::post(state_->loop, [this] { state_->close(); });
}

void IoStage::post(const PilotWord& word) {
  asio::post(state_->loop, [state = state_.get(), word] { state->drive.take(word, drivers::port::port_clock_now()); });
}

void IoStage::let_drive(bool may_drive, std::uint64_t ticket) {
  const DriveDesk::Request request{may_drive, ticket, drivers::port::port_clock_now()};
  asio::post(state_->loop, [state = state_.get(), request] {
    const control::CommandOutcome outcome = state->drive.let_drive(request, drivers::port::port_clock_now());
    if (state->wiring.answer) state->wiring.answer(outcome);
  });
}

void IoStage::take_by_hand(std::uint64_t who, std::function<void(const control::CommandOutcome&)> answer) {
  asio::post(state_->loop,
             [state = state_.get(), who, asked = drivers::port::port_clock_now(), answer = std::move(answer)] {
               answer(state->drive.take_by_hand(who, asked, drivers::port::port_clock_now()));
             });
}

void IoStage::drive_by_hand(std::uint64_t who, const DriveCommand& command) {
  asio::post(state_->loop, [state = state_.get(), who, command] { state->drive.drive_by_hand(who, command); });
}

void IoStage::let_go(std::uint64_t who) {
  asio::post(state_->loop, [state = state_.get(), who] { state->drive.let_go(who, drivers::port::port_clock_now()); });
}

void IoStage::set_safety(const navigation::SafetyParams& params) {
  asio::post(state_->loop, [state = state_.get(), params] { state->drive.set_safety(params); });
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
