// SPDX-License-Identifier: Apache-2.0
#include "simulation/scenario/scenario_world.hpp"

#include <yaml-cpp/yaml.h>

#include <algorithm>

namespace deltamap::simulation {
namespace {

constexpr double kRackPost_m = 0.08;  // across a pallet rack's upright

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
    for (const YAML::Node& rack : top_.items("racks")) read_rack(rack, scenario);
    for (const YAML::Node& pane : top_.items("glass")) read_pane(pane, scenario);
    for (const YAML::Node& pallet : top_.items("wrapped")) {
      add(scenario, ObjectKind::kContainer, box_of(pallet, top_.file()));
      scenario.world.objects.back().material = Material::kWrap;
    }
    if (scenario.world.objects.empty()) top_.refuse("walls", "is missing: there is nothing in this world");
  }

 private:
  void add(Scenario& scenario, ObjectKind kind, Shape shape) {
    scenario.world.objects.push_back({next_id_++, kind, std::move(shape)});
  }

  [[nodiscard]] Polyline line_of(const YAML::Node& list, const std::string& key, const std::string& complaint) const {
    if (!list.IsSequence() || list.size() < 2) refuse_at(list, top_.file(), key, complaint);
    Polyline line;
    for (const YAML::Node& point : list) line.points.push_back(point_of(numbers_of(point, 2, top_.file(), key)));
    return line;
  }

  [[nodiscard]] Polyline wall_of(const YAML::Node& wall) const {
    return line_of(wall, "walls", "must be lists of at least two points");
  }

  void read_pane(const YAML::Node& node, Scenario& scenario) {
    YamlSection pane{node, top_.file(), "glass"};
    if (!pane.has("line")) pane.refuse("line", "is missing in 'glass'");
    add(scenario, ObjectKind::kWall, line_of(node["line"], "line", "must be a list of at least two points"));
    scenario.world.objects.back().material = Material::kGlass;
    scenario.world.objects.back().is_drawn = pane.flag("drawn", true);
    pane.expect_no_more();
  }

  /// Equal thin posts in columns and rows; the first stands on the corner.
  void read_rack(const YAML::Node& node, Scenario& scenario) {
    YamlSection rack{node, top_.file(), "racks"};
    const auto corner = rack.numbers("corner", 3);
    const Pose2 map_from_rack{corner[0], corner[1], radians(corner[2])};
    const Point2 pitch = point_of(rack.numbers("pitch", 2));
    const int columns = rack.whole_number("columns", 1, 1, 1000);
    const int rows = rack.whole_number("rows", 1, 1, 1000);
    const double width_m = rack.number("width_m", kRackPost_m, kSmallest_m, 1.0);
    const bool round = rack.flag("round", false);
    if (pitch.minCoeff() <= width_m) rack.refuse("pitch", "must be more than a post's width");
    rack.expect_no_more();
    for (int row = 0; row < rows; ++row) {
      for (int column = 0; column < columns; ++column) {
        const Point2 centre = map_from_rack * Point2{column * pitch.x(), row * pitch.y()};
        add(scenario, ObjectKind::kPost,
            round ? Shape{Circle{centre, 0.5 * width_m}} : Shape{Box{centre, width_m, width_m, map_from_rack.theta}});
      }
    }
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

}  // namespace

void read_world(YamlSection& top, Scenario& scenario) { WorldReader{top}.read(scenario); }

}  // namespace deltamap::simulation
