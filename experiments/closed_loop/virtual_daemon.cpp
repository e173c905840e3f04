// SPDX-License-Identifier: Apache-2.0
#include "experiments/closed_loop/virtual_daemon.hpp"

#include <algorithm>
#include <utility>

#include "daemon/driving/drive_desk.hpp"
#include "daemon/replay/sequential_run.hpp"
#include "daemon/steps/pilot_step.hpp"
#include "daemon/steps/run_begin.hpp"
#include "drivers/lms200/session.hpp"
#include "drivers/pioneer/session.hpp"
#include "experiments/closed_loop/virtual_link.hpp"

namespace deltamap::experiments {
namespace {

using drivers::lms200::Lms200Output;
using drivers::lms200::Lms200Session;
using drivers::pioneer::PioneerOutput;
using drivers::pioneer::PioneerSession;
using drivers::port::PortId;

constexpr double kMapDelayS = 0.2;  // from a set of scans to its revision

daemon::Settings driving(daemon::Settings settings, bool has_map) {
  settings.navigation.mode = navigation::DriveMode::kWander;
  settings.robot.session.enable_motors = true;
  if (!has_map) settings.navigation.drive_without_pose = true;
  return settings;
}

drivers::pioneer::PioneerParams robot_params(const daemon::Settings& settings, const daemon::KeptDrive& kept) {
  auto params = settings.robot.session;
  params.drive_switch = kept.value();
  return params;
}

}  // namespace

struct VirtualDaemon::Process {
  explicit Process(VirtualDaemon& its_owner)
      : owner{its_owner},
        kept{{its_owner.params_.kept_file, "/dev/robot"}},
        listener{its_owner.params_.listener ? its_owner.params_.listener(telemetry) : nullptr},
        robot{
            PortId::kRobot,
            PioneerSession{robot_params(its_owner.params_.settings, kept), drivers::SessionMode::kLive},
            {[this](std::span<const std::uint8_t> bytes, unsigned baud) { owner.devices_.send_to_robot(bytes, baud); },
             [this](PioneerOutput& out) { take(out); },
             [this](std::string note) { record(PortId::kRobot, {}, std::move(note)); },
             [this](const std::string& line) { tell("robot: " + line); }}},
        laser{
            PortId::kLaser,
            Lms200Session{its_owner.params_.settings.laser.session, drivers::SessionMode::kLive},
            {[this](std::span<const std::uint8_t> bytes, unsigned baud) { owner.devices_.send_to_laser(bytes, baud); },
             [this](Lms200Output& out) { take(out); },
             [this](std::string note) { record(PortId::kLaser, {}, std::move(note)); },
             [this](const std::string& line) { tell("laser: " + line); }}},
        desk{true,
             its_owner.params_.settings.navigation.safety,
             {.session = robot.session(),
              .kept = kept,
              .telemetry = telemetry,
              .obey = [this](PioneerOutput out) { robot.handle(std::move(out), now()); },
              .log = [this](const std::string& line) { tell(line); },
              .warn = [this](const std::string& line) { tell(line); }}},
        pilot{its_owner.params_.settings} {
    if (its_owner.params_.map == nullptr) return;
    const daemon::StartMap start{.map = its_owner.params_.map};
    first_map = grid_hash(*its_owner.params_.map);
    run.emplace(its_owner.params_.settings, start, nullptr, kMapDelayS);
  }

  [[nodiscard]] Timestamp now() const { return owner.host_time_; }
  void tell(const std::string& line) const { owner.log_.push_back(line); }
  void tell(const drivers::SessionOutput& out) const {
    owner.log_.insert(owner.log_.end(), out.warnings.begin(), out.warnings.end());
    owner.log_.insert(owner.log_.end(), out.log.begin(), out.log.end());
  }

  void take(PioneerOutput& out) {
    for (const Odometry& odometry : out.odometry) {
      desk.observe(odometry, now());
      newest = odometry;
      owner.last_odometry_ = now();
      if (run) run->observe(odometry);
    }
    tell(out.output);
    desk.set_port_open(robot.is_open());
    telemetry.robot_up.set(desk.robot_is_connected());
    desk.obey_permission(now());
  }

  void take(Lms200Output& out) {
    tell(out.output);
    for (Scan& scan : out.scans) {
      scan.number = scans++;
      desk.set_nominal_scan_period(laser.session().nominal_period_s());
      desk.observe(scan);
      owner.last_scan_ = scan;
      desk.take(word_on(std::move(scan)), now());
    }
    telemetry.laser_up.set(laser.is_open() && laser.session().is_streaming());
  }

  void record(PortId port, const std::vector<std::uint8_t>& bytes, std::string note = {}) {
    if (!listener || (bytes.empty() && note.empty())) return;
    listener->hear({.port = port, .stamp = now(), .bytes = bytes, .note = std::move(note)}, now());
  }

  /// What the recorder thread is told of a scan.
  void tell_listener(const TrackedScan& tracked) {
    if (!listener) return;
    listener->hear(run->localization().row(), now());
    if (checked && seconds(tracked.scan.time - *checked) < daemon::kCheckpointPeriodS) return;
    checked = tracked.scan.time;
    listener->hear(std::make_shared<const daemon::Checkpoint>(
                       daemon::checkpoint_of(run->localization(), first_map, tracked.estimate.map)),
                   now());
  }

  /// What the localization thread says of a scan.
  daemon::PilotWord word_on(Scan scan) {
    if (owner.params_.pilot) return {.command = owner.params_.pilot(scan)};
    const TrackedScan tracked = run ? localized(std::move(scan)) : without_pose(std::move(scan));
    daemon::PilotStep::Seen seen;
    seen.times_let_drive = telemetry.times_let_drive.value();
    if (run) {
      seen.fit = run->localization().fit();
      for (const daemon::LogLine& line : run->localization().lines()) tell(line.text);
      seen.start_fits = run->localization().start_fits();
      seen.transients = run->store_scan().transients().get();
    }
    const daemon::PilotWord word = pilot.observe(tracked, seen);
    telemetry.pose_stop.set(static_cast<std::uint8_t>(word.pose));
    if (run && owner.params_.settings.mapping.enabled) follow_changes(tracked);
    return word;
  }

  TrackedScan localized(Scan scan) {
    run->take_what_is_due(scan);
    TrackedScan tracked = run->observe(std::move(scan));
    telemetry.localized.add(1);
    owner.estimate_ = tracked.estimate;
    tell_listener(tracked);
    return tracked;
  }

  TrackedScan without_pose(Scan scan) const {
    TrackedScan tracked;
    tracked.scan = std::move(scan);
    tracked.odom_from_robot = newest.odom_from_robot;
    tracked.odometry_epoch = newest.epoch;
    return tracked;
  }

  void follow_changes(const TrackedScan& tracked) {
    const auto request = run->look_for_changes(tracked);
    const auto result = request ? run->update_map(*request) : std::nullopt;
    if (!result) return;
    if (result->revision) {
      telemetry.newest_revision.set(result->revision->number);
    } else {
      telemetry.refused.add(1);
      if (mapping::scan_set::leaves_map_stale(result->refusal)) telemetry.stale_refusals.add(1);
    }
  }

  VirtualDaemon& owner;
  daemon::KeptDrive kept;
  daemon::Telemetry telemetry;
  std::unique_ptr<daemon::RunListener> listener;  // may be null
  VirtualLink<PioneerSession, PioneerOutput> robot;
  VirtualLink<Lms200Session, Lms200Output> laser;
  daemon::DriveDesk desk;
  daemon::PilotStep pilot;
  std::optional<daemon::SequentialRun> run;
  Odometry newest;
  std::uint32_t scans = 0;
  std::uint64_t first_map = 0;
  std::optional<Timestamp> checked;  // when the newest checkpoint was told
  Timestamp next_tick{};
};

VirtualDaemon::VirtualDaemon(simulation::Simulation& devices, Params params)
    : devices_{devices}, params_{std::move(params)} {
  params_.settings = driving(std::move(params_.settings), params_.map != nullptr);
}
VirtualDaemon::~VirtualDaemon() = default;

void VirtualDaemon::start() {
  process_ = std::make_unique<Process>(*this);
  follow_clock();
  process_->robot.start(host_time_);
  process_->laser.start(host_time_);
}

void VirtualDaemon::kill() { process_.reset(); }

daemon::RunListener* VirtualDaemon::listener() const { return process_ ? process_->listener.get() : nullptr; }

bool VirtualDaemon::is_alive() const { return process_ != nullptr; }

bool VirtualDaemon::operator_says(bool on) {
  if (!process_) return false;
  return process_->desk.let_drive({on, 1, host_time_}, host_time_).done ||
         !on;  // an off is kept although nobody can be told
}

bool VirtualDaemon::is_connected() const { return process_ && process_->desk.robot_is_connected(); }

navigation::AllowedMotion VirtualDaemon::last_allowed() const {
  return process_ ? process_->desk.allowed() : navigation::AllowedMotion{};
}

std::shared_ptr<const OccupancyGrid> VirtualDaemon::map() const {
  return process_ && process_->run ? process_->run->map().map() : params_.map;
}

std::optional<localization::motion::DriveCalibration> VirtualDaemon::calibration() const {
  return process_ && process_->run ? process_->run->localization().calibration() : std::nullopt;
}

bool VirtualDaemon::may_drive_by_pose() const { return process_ && daemon::may_drive_by_pose(process_->telemetry); }

bool VirtualDaemon::is_streaming() const { return process_ && process_->telemetry.laser_up.value(); }

void VirtualDaemon::follow_clock() {
  const Duration ahead = duration_from_seconds(devices_.faults().host_clock_ahead_s);
  host_time_ = std::max(host_time_, devices_.now() + ahead);
}

void VirtualDaemon::run(double duration_s, const std::function<void()>& each_step) {
  for (const Timestamp end = devices_.now() + duration_from_seconds(duration_s); devices_.now() < end;) {
    devices_.advance_to(std::min(end, devices_.next_event()));
    turn();
    each_step();
  }
}

void VirtualDaemon::turn() {
  constexpr unsigned kIdleBaud = 9600;
  follow_clock();
  const std::vector<std::uint8_t> from_robot = devices_.bytes_from_robot(process_ ? process_->robot.baud() : kIdleBaud);
  const std::vector<std::uint8_t> from_laser = devices_.bytes_from_laser(process_ ? process_->laser.baud() : kIdleBaud);
  if (!process_) return;
  if (on_bytes_) on_bytes_(from_robot, from_laser);
  const Timestamp now = host_time_;
  if (process_->robot.is_open()) process_->record(PortId::kRobot, from_robot);
  if (process_->laser.is_open()) process_->record(PortId::kLaser, from_laser);
  process_->robot.turn(from_robot, devices_.has_robot_port(), now);
  process_->laser.turn(from_laser, devices_.has_laser_port(), now);
  if (now < process_->next_tick) return;
  process_->next_tick = now + duration_from_seconds(daemon::kSafetyPeriodS);
  process_->desk.set_port_open(process_->robot.is_open());
  process_->telemetry.robot_up.set(process_->desk.robot_is_connected());
  process_->telemetry.laser_up.set(process_->laser.is_open() && process_->laser.session().is_streaming());
  process_->desk.tick(now);
  if (process_->listener) process_->listener->look(now);
}

}  // namespace deltamap::experiments
