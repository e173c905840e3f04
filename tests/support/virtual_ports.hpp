// SPDX-License-Identifier: Apache-2.0
// A robot that drives about in virtual time behind two ports of the live pipeline: its messages as the bytes that the
// devices would have sent, as fast as the pipeline takes them, so that none is overtaken.
#pragma once

#include <chrono>
#include <functional>
#include <optional>

#include "daemon/telemetry.hpp"
#include "daemon/tool/carmen_bytes.hpp"
#include "simulation/virtual_drive.hpp"
#include "tests/support/played_ports.hpp"

namespace deltamap::test {

class VirtualPorts final : public PlayedPorts {
 public:
  /// `passed` is told the virtual time, s, after each scan; it answers false to end the drive. In the io thread.
  VirtualPorts(const simulation::Scenario& scenario, const simulation::VirtualDriveParams& params,
               std::function<bool(double passed_s)> passed)
      : PlayedPorts{daemon::tool::kImportBaud}, drive_{scenario, params}, passed_{std::move(passed)} {
    survey_.measuring_mode = 0x06;  // 32 m
  }

  [[nodiscard]] Pose2 map_from_robot() const { return drive_.map_from_robot(); }
  /// Whose counts say what has been taken. Before anything plays.
  void follow(const daemon::Telemetry& telemetry) { telemetry_ = &telemetry; }

 private:
  [[nodiscard]] bool is_taken() const {
    if (telemetry_ == nullptr) return false;
    const std::uint64_t done = telemetry_->localized.value() + telemetry_->dropped.value();
    return telemetry_->scans.value() <= done + telemetry_->scans_lost.value();
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
    daemon::tool::CarmenScan scan;
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
  daemon::tool::CarmenSurvey survey_;
  daemon::tool::CarmenBytes bytes_{survey_, [this](const drivers::port::ByteRecord& record) { give(record); }};
  const daemon::Telemetry* telemetry_ = nullptr;
  std::optional<Timestamp> began_;
};

}  // namespace deltamap::test
