// SPDX-License-Identifier: Apache-2.0
#include "simulation/scenario/scenario.hpp"

#include <yaml-cpp/yaml.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <stdexcept>

#include "core/files/text_of_file.hpp"
#include "core/files/yaml_tree.hpp"
#include "simulation/devices/robot_kind.hpp"
#include "simulation/scenario/scenario_actors.hpp"
#include "simulation/scenario/scenario_world.hpp"
#include "simulation/scenario/yaml_section.hpp"

namespace deltamap::simulation {
namespace {

template <typename Number, std::size_t kCount>
void expect_one_of(const YamlSection& section, const std::string& key, Number value,
                   const std::array<Number, kCount>& allowed, const std::string& list) {
  if (std::find(allowed.begin(), allowed.end(), value) == allowed.end()) section.refuse(key, "must be one of " + list);
}

RobotParams body_of(YamlSection& robot, const devices::RobotKind& kind) {
  RobotParams body;
  body.radius_m = kind.hull_m;
  body.half_track_m = kind.half_track_m;
  body.radius_m = robot.number("radius_m", body.radius_m, kSmallest_m, 2.0);
  body.half_track_m = robot.number("half_track_m", body.half_track_m, kSmallest_m, 2.0);
  body.track_error = robot.number("track_error", body.track_error, -0.5, 0.5);
  body.left_wheel_error = robot.number("left_wheel_error", body.left_wheel_error, -0.5, 0.5);
  body.right_wheel_error = robot.number("right_wheel_error", body.right_wheel_error, -0.5, 0.5);
  body.wheel_noise_m_per_sqrt_m = robot.number("wheel_noise_m_per_sqrt_m", body.wheel_noise_m_per_sqrt_m, 0.0, 0.5);
  body.slips_per_m = robot.number("slips_per_m", body.slips_per_m, 0.0, 100.0);
  body.slip_length_m = robot.number("slip_length_m", body.slip_length_m, 0.0, 1.0);
  body.slip_share = robot.number("slip_share", body.slip_share, 0.0, 1.0);
  return body;
}

RobotSetup robot_of(YamlSection robot) {
  RobotSetup setup;
  const auto start = robot.numbers("start", 3);
  setup.map_from_start = {start[0], start[1], wrapped_angle(radians(start[2]))};
  setup.model = robot.text("model", setup.model);
  if (setup.model.empty()) robot.refuse("model", "must be the subtype of a robot, such as p3dx-sh");
  setup.baud = static_cast<unsigned>(robot.whole_number("baud", static_cast<int>(setup.baud), 9600, 115200));
  expect_one_of(robot, "baud", setup.baud, std::array{9600u, 19200u, 38400u, 57600u, 115200u},
                "9600, 19200, 38400, 57600, 115200");
  setup.sip_cycle_s = robot.number("sip_cycle_s", setup.sip_cycle_s, 0.02, 0.255);
  setup.watchdog_s = robot.number("watchdog_s", setup.watchdog_s, 0.1, 60.0);
  setup.battery_v = robot.number("battery_v", setup.battery_v, 1.0, 25.0);
  setup.sonars = robot.whole_number("sonars", setup.sonars, 0, 16);
  expect_one_of(robot, "sonars", setup.sonars, std::array{0, 8, 16}, "0, 8, 16");
  setup.has_bumpers = robot.flag("has_bumpers", setup.has_bumpers);
  setup.body = body_of(robot, devices::kind_of(setup.model));
  robot.expect_no_more();
  return setup;
}

SurfaceOptics surface_optics_of(YamlSection& laser) {
  SurfaceOptics optics;
  optics.glass_within_rad = radians(laser.number("glass_within_deg", degrees(optics.glass_within_rad), 0.0, 90.0));
  optics.wrap_no_return_share = laser.number("wrap_no_return_share", optics.wrap_no_return_share, 0.0, 1.0);
  optics.wrap_through_share = laser.number("wrap_through_share", optics.wrap_through_share, 0.0, 1.0);
  optics.wrap_dazzle_share = laser.number("wrap_dazzle_share", optics.wrap_dazzle_share, 0.0, 1.0);
  optics.wrap_short_share = laser.number("wrap_short_share", optics.wrap_short_share, 0.0, 1.0);
  optics.wrap_short_m = laser.number("wrap_short_m", optics.wrap_short_m, 0.0, 10.0);
  const double others = optics.wrap_no_return_share + optics.wrap_through_share + optics.wrap_dazzle_share;
  if (others + optics.wrap_short_share > 1.0) {
    laser.refuse("wrap_no_return_share", "and the other shares of wrap are more than 1 together");
  }
  return optics;
}

RangeFinderParams optics_of(YamlSection& laser) {
  RangeFinderParams optics;
  if (laser.has("mount")) {
    const auto mount = laser.numbers("mount", 3);
    optics.robot_from_laser = {mount[0], mount[1], wrapped_angle(radians(mount[2]))};
  }
  optics.range_noise_m = laser.number("range_noise_m", optics.range_noise_m, 0.0, 1.0);
  optics.range_bias_m = laser.number("range_bias_m", optics.range_bias_m, -1.0, 1.0);
  optics.dropout_share = laser.number("dropout_share", optics.dropout_share, 0.0, 1.0);
  optics.dazzle_share = laser.number("dazzle_share", optics.dazzle_share, 0.0, 1.0);
  optics.footprint_rad = radians(laser.number("footprint_deg", degrees(optics.footprint_rad), 0.0, 2.0));
  optics.mixed_share = laser.number("mixed_share", optics.mixed_share, 0.0, 1.0);
  optics.mixed_step_m = laser.number("mixed_step_m", optics.mixed_step_m, kSmallest_m, 10.0);
  optics.surfaces = surface_optics_of(laser);
  return optics;
}

LaserSetup laser_of(YamlSection laser) {
  LaserSetup setup;
  setup.baud = static_cast<unsigned>(laser.whole_number("baud", static_cast<int>(setup.baud), 9600, 500000));
  expect_one_of(laser, "baud", setup.baud, std::array{9600u, 19200u, 38400u, 500000u}, "9600, 19200, 38400, 500000");
  setup.field_deg = laser.whole_number("field_deg", setup.field_deg, 90, 180);
  expect_one_of(laser, "field_deg", setup.field_deg, std::array{90, 100, 180}, "90, 100, 180");
  setup.step_deg = laser.number("step_deg", setup.step_deg, 0.25, 1.0);
  expect_one_of(laser, "step_deg", setup.step_deg, std::array{0.25, 0.5, 1.0}, "0.25, 0.5, 1");
  if (setup.step_deg == 0.25 && setup.field_deg != 100) laser.refuse("step_deg", "of 0.25 needs 'field_deg' 100");
  if (setup.field_deg == 90 && setup.step_deg != 0.5) laser.refuse("step_deg", "must be 0.5 where 'field_deg' is 90");
  const std::string units = laser.text("units", "cm");
  if (units != "cm" && units != "mm") laser.refuse("units", "must be cm or mm");
  setup.resolution_m = units == "mm" ? 0.001 : 0.01;
  const double scale = units == "mm" ? 1.0 : 10.0;
  setup.max_range_m = laser.number("max_range_m", 8.0 * scale, 8.0, 320.0);
  expect_one_of(laser, "max_range_m", setup.max_range_m, std::array{8.0 * scale, 16.0 * scale, 32.0 * scale},
                units == "mm" ? "8, 16, 32 (mm)" : "80, 160, 320 (cm)");
  setup.optics = optics_of(laser);
  laser.expect_no_more();
  return setup;
}

FaultOrder fault_of(YamlSection fault) {
  constexpr double kLongest_s = 1e6;
  FaultOrder order;
  try {
    order = fault_order(fault.text("fault", ""));
  } catch (const std::invalid_argument& error) {
    fault.refuse("fault", std::string(": ") + error.what());
  }
  order.after_s += fault.number("after_s", 0.0, 0.0, kLongest_s);
  if (fault.has("for_s") && order.fault->is_momentary())
    fault.refuse("for_s", "is for what lasts: this is over in a moment");
  if (fault.has("for_s")) order.lasts_s = fault.number("for_s", 0.0, kShortestFault_s, kLongest_s);
  fault.expect_no_more();
  return order;
}

bool has_room_at_start(const Scenario& scenario) {
  const Point2 start = scenario.robot.map_from_start.position();
  return std::all_of(scenario.world.objects.begin(), scenario.world.objects.end(), [&](const Object& object) {
    return distance_between(start, object.shape) >= scenario.robot.body.radius_m;
  });
}

Scenario scenario_of(const YAML::Node& root, const std::string& name) {
  YamlSection top{root, name, "the scenario"};
  Scenario scenario;
  scenario.file = name;
  read_world(top, scenario);
  scenario.robot = robot_of(top.section("robot"));
  if (top.has("laser")) scenario.laser = laser_of(top.section("laser"));
  if (top.has("forklift")) scenario.forklift = forklift_of(top.section("forklift"));
  if (top.has("creep")) scenario.creep = creep_of(top.section("creep"));
  if (top.has("changed_at_start")) scenario.changed_at_start = changed_start_of(top.section("changed_at_start"));
  for (const YAML::Node& person : top.items("people"))
    scenario.people.push_back(person_of(YamlSection{person, name, "people"}));
  for (const YAML::Node& actor : top.items("actors"))
    scenario.actors.push_back(actor_of(YamlSection{actor, name, "actors"}));
  for (const YAML::Node& door : top.items("doors")) scenario.doors.push_back(door_of(YamlSection{door, name, "doors"}));
  for (const YAML::Node& fault : top.items("faults"))
    scenario.faults.push_back(fault_of(YamlSection{fault, name, "faults"}));
  top.expect_no_more();

  if (!has_room_at_start(scenario)) {
    refuse_at(root["robot"]["start"], name, "start", "puts the robot into a wall, a container or a post");
  }
  return scenario;
}

}  // namespace

Scenario with_robot(Scenario scenario, const std::string& subtype) {
  const devices::RobotKind kind = devices::kind_of(subtype);
  scenario.robot.model = subtype;
  scenario.robot.body.radius_m = kind.hull_m;
  scenario.robot.body.half_track_m = kind.half_track_m;
  if (has_room_at_start(scenario)) return scenario;
  throw std::runtime_error(scenario.file + ": 'start' leaves no room for the hull of a " + subtype);
}

Scenario parse_scenario(const std::string& yaml, const std::string& name) {
  YAML::Node root;
  try {
    root = only_yaml_tree(yaml);
  } catch (const YAML::Exception& error) {
    throw std::runtime_error(name + ": " + placed_meaning_of(error, yaml));
  }
  if (!root.IsMap()) throw std::runtime_error(name + ": line 1: not a scenario (expected 'walls', 'robot', ...)");
  return scenario_of(root, name);
}

Scenario read_scenario(const std::filesystem::path& yaml_file) {
  std::string text;
  try {
    text = text_of_file(yaml_file);
  } catch (const std::runtime_error& error) {
    throw std::runtime_error(yaml_file.string() + ": cannot be read: " + error.what());
  }
  return parse_scenario(text, yaml_file.string());
}

}  // namespace deltamap::simulation
