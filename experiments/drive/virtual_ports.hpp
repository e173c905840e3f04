// SPDX-License-Identifier: Apache-2.0
// A robot that drives about in virtual time behind two ports of the live pipeline: its messages as the bytes that the
// devices would have sent, as fast as the pipeline takes them, so that none is overtaken.
#pragma once

#include <algorithm>
#include <atomic>
#include <chrono>
#include <functional>
#include <optional>

#include "daemon/telemetry/telemetry.hpp"
#include "drivers/carmen/carmen_bytes.hpp"
#include "drivers/port/played_ports.hpp"
#include "simulation/virtual_drive.hpp"

namespace deltamap::experiments {

class VirtualPorts final : public drivers::port::PlayedPorts {
 public:
  /// `passed` is told the virtual time, s, after each scan; it answers false to end the drive. In the io thread.
  VirtualPorts(const simulation::Scenario& scenario, const simulation::VirtualDriveParams& params,
               std::function<bool(double passed_s)> passed)
      : PlayedPorts{drivers::carmen::kImportBaud}, drive_{scenario, params}, passed_{std::move(passed)} {
    survey_.measuring_mode = 0x06;  // 32 m
  }

  [[nodiscard]] Pose2 map_from_robot() const { return drive_.map_from_robot(); }
  /// Whose counts say what has been taken; nothing plays before.
  void follow(const daemon::Telemetry& telemetry) { telemetry_ = &telemetry; }

 private:
  /// The last scan has been localized, and the map thread, which comes last on a busy machine, is not left behind: with
  /// two sets before it the next could be lost.
  [[nodiscard]] bool is_taken() {
    const daemon::Telemetry* const telemetry = telemetry_;
    if (telemetry == nullptr) return false;
    const std::uint64_t localized = telemetry->localized.value() + telemetry->dropped.value();
    if (telemetry->scans.value() > localized + telemetry->scans_lost.value()) return false;
    // Before what was closed: a set that is closed and worked off in between must not look like an order.
    const std::int64_t worked_off =
        std::int64_t{telemetry->newest_revision.value()} + telemetry->refused.value() + telemetry->sets_lost.value();
    const std::int64_t closed = telemetry->phases_closed.value();
    orders_ = std::max(orders_, worked_off - closed);
    return closed + orders_ < worked_off + 2;
  }

  void play() override {
    timer_->expires_after(std::chrono::microseconds(is_taken() ? 0 : 200));
    timer_->async_wait([this](const boost::system::error_code& error) {
      if (error || !timer_) return;
      if (is_taken() && !step()) return timer_.reset();
      play();
    });
  }

  /// One scan and the odometry before it.
  bool step() {
    const simulation::DriveStep step = drive_.next();
    if (!began_) began_ = step.scan.time;
    for (const Odometry& odometry : step.odometry) bytes_.add_pose(odometry.time, odometry.odom_from_robot);
    drivers::carmen::CarmenScan scan;
    scan.time = step.scan.time;
    scan.first_bearing_rad = step.scan.first_bearing_rad;
    scan.bearing_step_rad = step.scan.bearing_step_rad;
    for (const Beam& beam : step.scan.beams) {
      constexpr double kNoReturn_m = 40.0;
      scan.ranges_m.push_back(beam.kind == BeamKind::kRange ? static_cast<double>(beam.range_m) : kNoReturn_m);
    }
    bytes_.add_scan(scan);
    return passed_(seconds(step.scan.time - *began_));
  }

  simulation::VirtualDrive drive_;
  std::function<bool(double)> passed_;
  drivers::carmen::CarmenSurvey survey_;
  drivers::carmen::CarmenBytes bytes_{survey_, [this](const drivers::port::ByteRecord& record) { give(record); }};
  std::atomic<const daemon::Telemetry*> telemetry_ = nullptr;
  std::int64_t orders_ = 0;  // to withdraw: worked off like sets, but no phase
  std::optional<Timestamp> began_;
};

}  // namespace deltamap::experiments
