// SPDX-License-Identifier: Apache-2.0
#include "simulation/scenario.hpp"

#include <yaml-cpp/yaml.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <fstream>
#include <iterator>
#include <stdexcept>

#include "simulation/yaml_section.hpp"

namespace deltamap::simulation {
namespace {

constexpr double kLargest_m = 1000.0;  // of any length in a scenario
constexpr double kSmallest_m = 0.01;

Point2 point_of(const std::vector<double>& numbers) { return {numbers[0], numbers[1]}; }

Box box_of(const YAML::Node& node, const std::string& file) {
  const auto n = numbers_of(node, 5, file, "box");
  if (n[2] < kSmallest_m || n[3] < kSmallest_m) refuse_at(node, file, "box", "needs a width and a height");
  return {{n[0], n[1]}, n[2], n[3], radians(n[4])};
}

/// Gives the world's things their numbers in the order of the file.
class WorldReader {
 public:
  explicit WorldReader(YamlSection& top) : top_{top} {}

  void read(Scenario& scenario) {
    for (const YAML::Node& wall : top_.items("walls")) add(scenario, ObjectKind::kWall, wall_of(wall));
    for (const YAML::Node& block : top_.items("blocks")) read_block(block, scenario);
    for (const YAML::Node& container : top_.items("containers")) {
      const Box box = box_of(container, top_.file());
      add(scenario, ObjectKind::kContainer, box);
      scenario.slots.push_back(box);
    }
    for (const YAML::Node& post : top_.items("posts")) add(scenario, ObjectKind::kPost, post_of(post));
    if (scenario.world.objects.empty()) top_.refuse("walls", "is missing: there is nothing in this world");
  }

 private:
  void add(Scenario& scenario, ObjectKind kind, Shape shape) {
    scenario.world.objects.push_back({next_id_++, kind, std::move(shape)});
  }

  [[nodiscard]] Polyline wall_of(const YAML::Node& wall) const {
    if (!wall.IsSequence() || wall.size() < 2)
      refuse_at(wall, top_.file(), "walls", "must be lists of at least two points");
    Polyline line;
    for (const YAML::Node& point : wall) line.points.push_back(point_of(numbers_of(point, 2, top_.file(), "walls")));
    return line;
  }

  [[nodiscard]] Shape post_of(const YAML::Node& node) const {
    YamlSection post{node, top_.file(), "posts"};
    Shape shape;
    if (post.has("box")) {
      shape = box_of(node["box"], top_.file());
    } else {
      const auto n = post.numbers("circle", 3);
      if (n[2] < kSmallest_m) post.refuse("circle", "needs a radius");
      shape = Circle{{n[0], n[1]}, n[2]};
    }
    post.expect_no_more();
    return shape;
  }

  /// A block of equal containers in columns and rows, some of whose slots may be empty at the start.
  void read_block(const YAML::Node& node, Scenario& scenario) {
    YamlSection block{node, top_.file(), "blocks"};
    const Point2 corner = point_of(block.numbers("corner", 2));
    const Point2 size = point_of(block.numbers("size", 2));
    if (size.minCoeff() < kSmallest_m) block.refuse("size", "must be positive");
    const int columns = block.whole_number("columns", 1, 1, 1000);
    const int rows = block.whole_number("rows", 1, 1, 1000);
    std::vector<Cell> empty;
    for (const YAML::Node& slot : block.items("empty")) {
      const auto n = numbers_of(slot, 2, top_.file(), "empty");
      empty.push_back({static_cast<int>(n[0]), static_cast<int>(n[1])});
    }
    block.expect_no_more();
    for (int row = 0; row < rows; ++row) {
      for (int column = 0; column < columns; ++column) {
        const Box box{corner + Point2{(column + 0.5) * size.x(), (row + 0.5) * size.y()}, size.x(), size.y(), 0.0};
        scenario.slots.push_back(box);
        if (std::find(empty.begin(), empty.end(), Cell{column, row}) == empty.end()) {
          add(scenario, ObjectKind::kContainer, box);
        }
      }
    }
  }

  YamlSection& top_;
  int next_id_ = 1;
};

template <typename Number, std::size_t kCount>
void expect_one_of(const YamlSection& section, const std::string& key, Number value,
                   const std::array<Number, kCount>& allowed, const std::string& list) {
  if (std::find(allowed.begin(), allowed.end(), value) == allowed.end()) section.refuse(key, "must be one of " + list);
}

RobotParams body_of(YamlSection& robot) {
  RobotParams body;
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
  if (setup.model != "p3dx-sh" && setup.model != "p3dx") robot.refuse("model", "must be p3dx-sh or p3dx");
  setup.baud = static_cast<unsigned>(robot.whole_number("baud", static_cast<int>(setup.baud), 9600, 115200));
  expect_one_of(robot, "baud", setup.baud, std::array{9600u, 19200u, 38400u, 57600u, 115200u},
                "9600, 19200, 38400, 57600, 115200");
  setup.sip_cycle_s = robot.number("sip_cycle_s", setup.sip_cycle_s, 0.02, 0.255);
  setup.watchdog_s = robot.number("watchdog_s", setup.watchdog_s, 0.1, 60.0);
  setup.battery_v = robot.number("battery_v", setup.battery_v, 1.0, 25.0);
  setup.sonars = robot.whole_number("sonars", setup.sonars, 0, 16);
  expect_one_of(robot, "sonars", setup.sonars, std::array{0, 8, 16}, "0, 8, 16");
  setup.has_bumpers = robot.flag("has_bumpers", setup.has_bumpers);
  setup.body = body_of(robot);
  robot.expect_no_more();
  return setup;
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
  return optics;
}

LaserSetup laser_of(YamlSection laser) {
  LaserSetup setup;
  setup.baud = static_cast<unsigned>(laser.whole_number("baud", static_cast<int>(setup.baud), 9600, 500000));
  expect_one_of(laser, "baud", setup.baud, std::array{9600u, 19200u, 38400u, 500000u}, "9600, 19200, 38400, 500000");
  setup.field_deg = laser.whole_number("field_deg", setup.field_deg, 100, 180);
  expect_one_of(laser, "field_deg", setup.field_deg, std::array{100, 180}, "100, 180");
  setup.step_deg = laser.number("step_deg", setup.step_deg, 0.25, 1.0);
  expect_one_of(laser, "step_deg", setup.step_deg, std::array{0.25, 0.5, 1.0}, "0.25, 0.5, 1");
  if (setup.step_deg == 0.25 && setup.field_deg != 100) laser.refuse("step_deg", "of 0.25 needs 'field_deg' 100");
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

ForkliftParams forklift_of(YamlSection lift) {
  ForkliftParams params;
  params.change_every_s = lift.number("change_every_s", params.change_every_s, 0.1, 1e6);
  if (lift.has("changes")) params.kinds.clear();
  for (const YAML::Node& item : lift.items("changes")) {
    const auto kind = change_kind_named(item.IsScalar() ? item.Scalar() : "");
    if (!kind) refuse_at(item, lift.file(), "changes", "must list removed, added or shifted");
    params.kinds.push_back(*kind);
  }
  params.smallest_shift_m = lift.number("smallest_shift_m", params.smallest_shift_m, kSmallest_m, kLargest_m);
  params.largest_shift_m = lift.number("largest_shift_m", params.largest_shift_m, params.smallest_shift_m, kLargest_m);
  params.robot_margin_m = lift.number("robot_margin_m", params.robot_margin_m, 0.0, kLargest_m);
  params.people_margin_m = lift.number("people_margin_m", params.people_margin_m, 0.0, kLargest_m);
  params.passage_m = lift.number("passage_m", params.passage_m, 0.1, kLargest_m);
  params.least_filled = lift.number("least_filled", params.least_filled, 0.0, 1.0);
  lift.expect_no_more();
  return params;
}

PersonParams person_of(YamlSection person) {
  PersonParams params;
  for (const YAML::Node& corner : person.items("path")) {
    params.path.push_back(point_of(numbers_of(corner, 2, person.file(), "path")));
  }
  if (params.path.size() < 2) person.refuse("path", "must have at least two points");
  params.closed = person.flag("closed", params.closed);
  params.speed_m_per_s = person.number("speed_m_per_s", params.speed_m_per_s, 0.05, 5.0);
  params.radius_m = person.number("radius_m", params.radius_m, 0.03, 1.0);
  params.walk_least_s = person.number("walk_least_s", params.walk_least_s, 0.1, 1e6);
  params.walk_most_s =
      person.number("walk_most_s", std::max(params.walk_most_s, params.walk_least_s), params.walk_least_s, 1e6);
  params.stand_least_s = person.number("stand_least_s", params.stand_least_s, 0.0, 1e6);
  params.stand_most_s =
      person.number("stand_most_s", std::max(params.stand_most_s, params.stand_least_s), params.stand_least_s, 1e6);
  person.expect_no_more();
  return params;
}

Scenario scenario_of(const YAML::Node& root, const std::string& name) {
  YamlSection top{root, name, "the scenario"};
  Scenario scenario;
  scenario.file = name;
  WorldReader{top}.read(scenario);
  scenario.robot = robot_of(top.section("robot"));
  if (top.has("laser")) scenario.laser = laser_of(top.section("laser"));
  if (top.has("forklift")) scenario.forklift = forklift_of(top.section("forklift"));
  for (const YAML::Node& person : top.items("people"))
    scenario.people.push_back(person_of(YamlSection{person, name, "people"}));
  top.expect_no_more();

  const Point2 start = scenario.robot.map_from_start.position();
  for (const Object& object : scenario.world.objects) {
    if (distance_between(start, object.shape) >= scenario.robot.body.radius_m) continue;
    refuse_at(root["robot"]["start"], name, "start", "puts the robot into a wall, a container or a post");
  }
  return scenario;
}

}  // namespace

Scenario parse_scenario(const std::string& yaml, const std::string& name) {
  YAML::Node root;
  try {
    root = YAML::Load(yaml);
  } catch (const YAML::Exception& error) {
    throw std::runtime_error(name + ": line " + std::to_string(error.mark.line + 1) + ": " + error.msg);
  }
  if (!root.IsMap()) throw std::runtime_error(name + ": line 1: not a scenario (expected 'walls', 'robot', ...)");
  return scenario_of(root, name);
}

Scenario read_scenario(const std::filesystem::path& yaml_file) {
  std::ifstream in(yaml_file, std::ios::binary);
  if (!in || std::filesystem::is_directory(yaml_file))
    throw std::runtime_error(yaml_file.string() + ": cannot be read");
  return parse_scenario({std::istreambuf_iterator<char>(in), {}}, yaml_file.string());
}

}  // namespace deltamap::simulation
