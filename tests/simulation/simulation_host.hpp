// SPDX-License-Identifier: Apache-2.0
// Both sessions on both lines of a simulation, in virtual time.
#pragma once

#include <algorithm>
#include <optional>
#include <string>
#include <vector>

#include "drivers/lms200/session.hpp"
#include "drivers/pioneer/session.hpp"
#include "simulation/simulation.hpp"
#include "tests/support/files/source_tree.hpp"

namespace deltamap::simulation {

inline constexpr Timestamp kStart = timestamp_from_ns(1'700'000'000'000'000'000);

inline Scenario delivered(const std::string& name) {
  return read_scenario(test::source_path("config/scenarios/") + name + ".yaml");
}

/// Both sessions on both lines of a simulation.
class Host {
 public:
  Host(const Scenario& scenario, std::uint64_t seed, unsigned wanted_baud = 38400)
      : simulation{scenario, {seed, kStart, std::nullopt}},
        robot_session{robot_params(), drivers::SessionMode::kLive},
        laser_session{laser_params(wanted_baud), drivers::SessionMode::kLive} {
    obey_robot(robot_session.start(kStart));
    obey_laser(laser_session.start(kStart));
  }

  void run_for(double seconds) {
    const Timestamp end = simulation.now() + duration_from_seconds(seconds);
    while (simulation.now() < end) {
      simulation.advance_to(std::min(end, simulation.next_event()));
      const Timestamp now = simulation.now();
      if (const auto bytes = simulation.bytes_from_robot(robot_baud); !bytes.empty()) {
        obey_robot(robot_session.on_bytes(bytes, now));
      }
      if (const auto bytes = simulation.bytes_from_laser(laser_baud); !bytes.empty()) {
        obey_laser(laser_session.on_bytes(bytes, now));
      }
      if (robot_wake && *robot_wake <= now) obey_robot(robot_session.on_time(now));
      if (laser_wake && *laser_wake <= now) obey_laser(laser_session.on_time(now));
      for (auto& record : simulation.take_truth()) truth.push_back(record);
    }
  }
  /// As after a crash: the devices go on as they were, a new program knows nothing of it.
  void restart_sessions() {
    robot_session = drivers::pioneer::PioneerSession{robot_params(), drivers::SessionMode::kLive};
    laser_session = drivers::lms200::Lms200Session{laser_params(38400), drivers::SessionMode::kLive};
    obey_robot(robot_session.start(simulation.now()));
    obey_laser(laser_session.start(simulation.now()));
  }
  void drive(double speed, double turn_rate) {
    obey_robot(robot_session.drive({simulation.now(), speed, turn_rate}, simulation.now()));
  }
  void emergency_stop() { obey_robot(robot_session.emergency_stop(simulation.now())); }

  Simulation simulation;
  drivers::pioneer::PioneerSession robot_session;
  drivers::lms200::Lms200Session laser_session;
  std::vector<Odometry> odometry;
  std::vector<Scan> scans;
  std::vector<TruthRecord> truth;
  std::string failure;

 private:
  static drivers::pioneer::PioneerParams robot_params() {
    drivers::pioneer::PioneerParams params;
    params.enable_motors = true;
    params.drive_switch = drivers::pioneer::DriveSwitch::kOn;
    return params;
  }
  static drivers::lms200::Lms200Params laser_params(unsigned baud) {
    drivers::lms200::Lms200Params params;
    params.baud = baud;
    return params;
  }
  void obey_robot(const drivers::pioneer::PioneerOutput& out) {
    odometry.insert(odometry.end(), out.odometry.begin(), out.odometry.end());
    for (const auto& request : out.output.requests) {
      if (request.kind == drivers::PortRequest::Kind::kWrite) simulation.send_to_robot(request.bytes, robot_baud);
      if (request.kind == drivers::PortRequest::Kind::kSetBaud) robot_baud = request.baud;
    }
    robot_wake = out.output.wake_at;
    if (out.output.failed) failure = "robot: " + *out.output.failed;
  }
  void obey_laser(const drivers::lms200::Lms200Output& out) {
    scans.insert(scans.end(), out.scans.begin(), out.scans.end());
    for (const auto& request : out.output.requests) {
      if (request.kind == drivers::PortRequest::Kind::kWrite) simulation.send_to_laser(request.bytes, laser_baud);
      if (request.kind == drivers::PortRequest::Kind::kSetBaud) laser_baud = request.baud;
    }
    laser_wake = out.output.wake_at;
    if (out.output.failed) failure = "laser: " + *out.output.failed;
  }

  unsigned robot_baud = 9600;
  unsigned laser_baud = 9600;
  std::optional<Timestamp> robot_wake;
  std::optional<Timestamp> laser_wake;
};

}  // namespace deltamap::simulation
