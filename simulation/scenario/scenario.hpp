// SPDX-License-Identifier: Apache-2.0
// A scenario: the world at the start, the robot and its laser, the fork-lift and the people. Read from YAML, strictly:
// a key that nothing reads is an error.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "simulation/changes/changed_hall.hpp"
#include "simulation/changes/creep.hpp"
#include "simulation/changes/forklift.hpp"
#include "simulation/faults/named_fault.hpp"
#include "simulation/movers/movers.hpp"
#include "simulation/robot/range_finder.hpp"
#include "simulation/robot/robot.hpp"
#include "simulation/world/world.hpp"

namespace deltamap::simulation {

/// The P3-DX as it is switched on.
struct RobotSetup {
  std::string model = "p3dx-sh";  ///< the subtype that it tells: unit of its odometry, track and hull (protocols.md A7)
  Pose2 map_from_start;
  unsigned baud = 9600;      ///< one of 9600, 19200, 38400, 57600, 115200 (A4)
  double sip_cycle_s = 0.1;  ///< between two SIPs (A6), [0.02, 1]
  double watchdog_s = 2.0;   ///< of silence until it stops (A9), > 0
  double battery_v = 12.8;   ///< > 0
  int sonars = 8;            ///< 0, 8 or 16
  bool has_bumpers = false;  ///< five segments in front and five behind
  RobotParams body;
};

/// The LMS200 as it is switched on.
struct LaserSetup {
  unsigned baud = 9600;        ///< one of 9600, 19200, 38400, 500000 (protocols.md B3)
  int field_deg = 180;         ///< 90, 100 or 180
  double step_deg = 0.5;       ///< 0.25 (100° only), 0.5 (90°: only that) or 1
  double resolution_m = 0.01;  ///< unit of a reading: 0.01 or 0.001 (B4 byte 6)
  double max_range_m = 80.0;   ///< 8, 16, 32 at 1 mm or 80, 160, 320 at 10 mm (B4 byte 5)
  RangeFinderParams optics;
};

struct Scenario {
  std::string file;
  World world;
  std::vector<Box> slots;  ///< where the fork-lift may put containers
  RobotSetup robot;
  LaserSetup laser;
  std::optional<ForkliftParams> forklift;
  std::vector<PersonParams> people;
  std::vector<ActorParams> actors;
  std::vector<DoorParams> doors;
  std::optional<CreepParams> creep;
  std::vector<FaultOrder> faults;
  std::optional<ChangedStartParams> changed_at_start;  ///< the world above is that of M_0
};

/// Throws std::runtime_error: one line that names file, line and key.
[[nodiscard]] Scenario read_scenario(const std::filesystem::path& yaml_file);

/// The scenario with another robot in it: subtype, units, track and hull. Throws std::runtime_error where it has no
/// room at the start.
[[nodiscard]] Scenario with_robot(Scenario scenario, const std::string& subtype);

/// The same from text; `name` stands for the file in messages.
[[nodiscard]] Scenario parse_scenario(const std::string& yaml, const std::string& name);

}  // namespace deltamap::simulation
