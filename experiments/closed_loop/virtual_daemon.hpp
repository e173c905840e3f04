// SPDX-License-Identifier: Apache-2.0
// The daemon in virtual time between the two devices of a simulation: sessions, drive desk, pilot and, where it is
// given a map, localizer and Δ-mapping, as the threads of pipeline.cpp run them. What it drives moves a body in a
// world, so that it can bump into things. Killed and started again like a process.
#pragma once

#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "core/grid/occupancy_grid.hpp"
#include "daemon/records/run_listener.hpp"
#include "daemon/settings/settings.hpp"
#include "daemon/telemetry/telemetry.hpp"
#include "navigation/safety.hpp"
#include "simulation/simulation.hpp"

namespace deltamap::experiments {

class VirtualDaemon {
 public:
  struct Params {
    daemon::Settings settings;                         ///< navigation.mode is taken for wander
    std::shared_ptr<const OccupancyGrid> map{};        ///< M_0; null: no localizer, it wanders without a pose
    std::filesystem::path kept_file{};                 ///< of the drive switch; empty: not kept
    std::function<DriveCommand(const Scan&)> pilot{};  ///< in place of wandering
    /// Who hears in the recorder's place, of each process; empty: nobody.
    std::function<std::unique_ptr<daemon::RunListener>(daemon::Telemetry&)> listener{};
  };
  VirtualDaemon(simulation::Simulation& devices, Params params);
  ~VirtualDaemon();
  VirtualDaemon(const VirtualDaemon&) = delete;
  VirtualDaemon& operator=(const VirtualDaemon&) = delete;

  void start();
  void kill();
  [[nodiscard]] bool is_alive() const;
  /// Time passes; `each_step` is called a few milliseconds apart.
  void run(
      double duration_s, const std::function<void()>& each_step = [] {});

  // What befalls it.
  /// The robot's line carries nothing in either direction.
  void cut_line(bool is_cut) { devices_.faults().robot_line.is_cut = is_cut; }
  /// Half a cable: the robot hears us, we do not hear it.
  void cut_answers(bool are_cut) { devices_.faults().robot_line.is_mute = are_cut; }
  /// The adapter is pulled out: the port hangs up and cannot be opened.
  void pull_adapter(bool is_out) { devices_.faults().robot_line.is_unplugged = is_out; }
  /// `deltamap ctl drive wander` or `drive off`: whether that is kept.
  [[nodiscard]] bool operator_says(bool on);

  // What it does.
  [[nodiscard]] bool is_connected() const;
  /// Scans come from a laser that is set up as wanted.
  [[nodiscard]] bool is_streaming() const;
  [[nodiscard]] Timestamp last_odometry() const { return last_odometry_; }
  [[nodiscard]] navigation::AllowedMotion last_allowed() const;
  [[nodiscard]] const std::optional<Scan>& last_scan() const { return last_scan_; }
  /// As Δ-mapping has made it; null without a first map.
  [[nodiscard]] std::shared_ptr<const OccupancyGrid> map() const;
  /// Of the newest localized scan; nothing without a map.
  [[nodiscard]] const std::optional<Estimate>& estimate() const { return estimate_; }
  /// What would be kept of wheels and mount; nothing without a map.
  [[nodiscard]] std::optional<localization::motion::DriveCalibration> calibration() const;
  /// What ctl status tells planners.
  [[nodiscard]] bool may_drive_by_pose() const;
  /// Of the process that is alive; null: nobody listens.
  [[nodiscard]] daemon::RunListener* listener() const;
  /// Of the clock that stamps what it hears: the devices' unless it has leapt; it never goes back.
  [[nodiscard]] Timestamp host_time() const { return host_time_; }
  /// Hears every byte that reaches it from the robot and from the laser, as it is after the line.
  using Bytes = std::span<const std::uint8_t>;
  void set_listener(std::function<void(Bytes from_robot, Bytes from_laser)> on_bytes) {
    on_bytes_ = std::move(on_bytes);
  }
  /// Lines of its log, of all processes so far.
  [[nodiscard]] const std::vector<std::string>& log() const { return log_; }

 private:
  struct Process;
  void turn();
  void follow_clock();

  simulation::Simulation& devices_;
  Params params_;
  std::unique_ptr<Process> process_;  // what dies with it
  Timestamp host_time_{};
  Timestamp last_odometry_{};
  std::function<void(Bytes, Bytes)> on_bytes_;
  std::optional<Scan> last_scan_;
  std::optional<Estimate> estimate_;
  std::vector<std::string> log_;
};

}  // namespace deltamap::experiments
