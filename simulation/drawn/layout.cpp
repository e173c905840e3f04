// SPDX-License-Identifier: Apache-2.0
#include "simulation/drawn/layout.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/geometry/angle.hpp"
#include "simulation/drawn/layout_builder.hpp"

namespace deltamap::simulation::drawn {
namespace {

constexpr double kHallPassage_m = 1.4;
constexpr double kDoorPassage_m = 0.9;

int whole(int least, int most, Random& random) {
  return least + static_cast<int>(random.index_below(static_cast<std::uint32_t>(most - least + 1)));
}

/// Every second building stands square in its map; the others are turned, as surveys leave them.
Pose2 anywhere(Random& random, bool always_turned = false) {
  const bool is_turned = always_turned || random.uniform() < 0.5;
  return {random.uniform(), random.uniform(), is_turned ? radians(random.uniform(-45.0, 45.0)) : 0.0};
}

Layout blocks(Random& random) {
  LayoutBuilder builder{random};
  const Point2 size{random.uniform(1.0, 3.5), random.uniform(1.0, 3.5)};
  const double aisle_m = random.uniform(2.4, 5.0);
  const int columns = whole(2, 4, random);
  const int rows = whole(2, 4, random);
  const int in_block = whole(2, 4, random);
  const Point2 pitch = in_block * size + Point2::Constant(aisle_m);
  const Point2 far{columns * pitch.x() + aisle_m, rows * pitch.y() + aisle_m};
  builder.walls_round(rectangle({0.0, 0.0}, far));
  for (int i = 0; i < columns * rows * in_block * in_block; ++i) {
    const int column = i % (columns * in_block);
    const int row = i / (columns * in_block);
    const Point2 corner{aisle_m + (column / in_block) * pitch.x() + (column % in_block) * size.x(),
                        aisle_m + (row / in_block) * pitch.y() + (row % in_block) * size.y()};
    builder.slot({corner + 0.5 * size, size.x(), size.y(), 0.0});
  }
  return builder.finished(kHallPassage_m, anywhere(random));
}

Layout rack_aisles(Random& random) {
  LayoutBuilder builder{random};
  const double bay_m = random.uniform(1.3, 2.8);
  const double depth_m = random.uniform(0.8, 1.3);
  const double aisle_m = random.uniform(2.4, 3.6);
  const double post_m = random.uniform(0.08, 0.14);
  const int bays = whole(6, 14, random);
  const int rows = whole(3, 8, random);
  const double head_m = random.uniform(2.5, 5.0);  // before the ends of the rows
  const Point2 far{2.0 * head_m + bays * bay_m, aisle_m + rows * (2.0 * depth_m + aisle_m)};
  builder.walls_round(rectangle({0.0, 0.0}, far));
  for (int row = 0; row < rows; ++row) {
    const double low_m = aisle_m + row * (2.0 * depth_m + aisle_m);
    for (int bay = 0; bay <= bays; ++bay) {
      const double x_m = head_m + bay * bay_m;
      for (const double y_m : {low_m, low_m + 2.0 * depth_m}) builder.post({{x_m, y_m}, post_m, post_m, 0.0});
      if (bay == bays) break;
      for (const double side : {0.5, 1.5}) {
        const double length_m = random.uniform(0.5, 0.9) * (bay_m - post_m);
        const double middle_m = x_m + 0.5 * bay_m + random.uniform(-0.05, 0.05);
        builder.slot({{middle_m, low_m + side * depth_m}, length_m, random.uniform(0.6, 0.95) * depth_m, 0.0});
      }
    }
  }
  return builder.finished(kHallPassage_m, anywhere(random));
}

/// One row of rooms along the line y = wall_m; `outwards` is 1 above the corridor and -1 below.
void rooms(LayoutBuilder& builder, double length_m, double wall_m, double depth_m, double outwards, Random& random) {
  const double back_m = wall_m + outwards * depth_m;
  for (double x_m = 0.0; x_m < length_m;) {
    const double width_m = random.uniform(3.2, 7.0);
    double end_m = x_m + width_m;
    if (length_m - end_m < 3.2) end_m = length_m;
    const double door_m = random.uniform(1.3, 1.8);
    const double begin_m = random.uniform(x_m + 0.4, end_m - door_m - 0.4);
    builder.wall({{x_m, wall_m}, {begin_m, wall_m}});
    builder.wall({{begin_m + door_m, wall_m}, {end_m, wall_m}});
    if (end_m < length_m) builder.wall({{end_m, wall_m}, {end_m, back_m}});
    const Point2 middle{0.5 * (x_m + end_m), 0.5 * (wall_m + back_m)};
    const int things = whole(1, 4, random);
    for (int i = 0; i < things; ++i) {
      const double side = random.uniform();
      const Segment back{{x_m, back_m}, {end_m, back_m}};
      const Segment left{{x_m, middle.y()}, {x_m, back_m}};
      const Segment right{{end_m, middle.y()}, {end_m, back_m}};
      builder.lean(side < 0.5 ? back : side < 0.75 ? left : right, middle, {.most_m = 2.0, .way_m = 1.1}, 0.9);
    }
    x_m = end_m;
  }
}

Layout offices(Random& random) {
  LayoutBuilder builder{random};
  const double length_m = random.uniform(24.0, 48.0);
  const double corridor_m = random.uniform(2.0, 3.2);
  const double depth_m = random.uniform(3.6, 6.5);
  builder.walls_round(rectangle({0.0, -depth_m}, {length_m, corridor_m + depth_m}));
  rooms(builder, length_m, corridor_m, depth_m, 1.0, random);
  rooms(builder, length_m, 0.0, depth_m, -1.0, random);
  return builder.finished(kDoorPassage_m, anywhere(random));
}

/// Solid blocks of one size side by side; from a corridor between two of them nobody can tell which it is.
Layout corridors(Random& random) {
  LayoutBuilder builder{random};
  const double width_m = random.uniform(2.1, 3.2);
  const Point2 block{random.uniform(3.0, 7.0), random.uniform(9.0, 20.0)};
  const int count = whole(4, 8, random);
  const bool is_comb = random.uniform() < 0.5;
  const double high_m = block.y() + (is_comb ? 1.0 : 2.0) * width_m;
  builder.walls_round(rectangle({0.0, 0.0}, {width_m + count * (block.x() + width_m), high_m}));
  std::vector<Segment> sides;
  for (int i = 0; i < count; ++i) {
    const Point2 low{width_m + i * (block.x() + width_m), width_m};
    const Point2 high = low + block;
    builder.walls_round(rectangle(low, high));
    sides.push_back({{high.x(), low.y()}, high});
  }
  const int tries = whole(4 * count, 16 * count, random);  // most of them where there is no room
  for (int i = 0; i < tries; ++i) {
    const Segment& side = sides[random.index_below(static_cast<std::uint32_t>(sides.size()))];
    builder.lean(side, side.from + Point2{1.0, 1.0}, {.most_m = 1.2, .way_m = width_m - 0.7}, 0.6);
  }
  return builder.finished(kDoorPassage_m, anywhere(random));
}

Layout bent_hall(Random& random) {
  LayoutBuilder builder{random};
  const double arm_m = random.uniform(6.0, 13.0);
  const double length_m = random.uniform(20.0, 40.0);
  const double left_m = random.uniform(14.0, 30.0);
  const double right_m = random.uniform(14.0, 30.0);
  std::vector<Point2> outline{{0.0, 0.0}, {length_m, 0.0}};
  if (random.uniform() < 0.5) {  // L
    outline.insert(outline.end(), {{length_m, arm_m}, {arm_m, arm_m}, {arm_m, left_m}, {0.0, left_m}});
  } else {  // U
    const double inner_m = length_m - arm_m;
    outline.insert(outline.end(), {{length_m, right_m},
                                   {inner_m, right_m},
                                   {inner_m, arm_m},
                                   {std::min(arm_m, inner_m - 2.0), arm_m},
                                   {std::min(arm_m, inner_m - 2.0), left_m},
                                   {0.0, left_m}});
  }
  builder.walls_round(outline);
  builder.scatter(whole(12, 36, random), outline, {});
  return builder.finished(kHallPassage_m, anywhere(random));
}

Layout oblique(Random& random) {
  LayoutBuilder builder{random};
  const int corners = whole(5, 9, random);
  std::vector<Point2> outline;
  for (int i = 0; i < corners; ++i) {
    const double angle_rad = 2.0 * std::numbers::pi * (i + random.uniform(-0.3, 0.3)) / corners;
    const double away_m = random.uniform(11.0, 24.0);
    outline.push_back({away_m * std::cos(angle_rad), away_m * std::sin(angle_rad)});
  }
  builder.walls_round(outline);
  const int walls = whole(1, 4, random);
  for (int i = 0; i < walls; ++i) {
    const double angle_rad = random.uniform(-std::numbers::pi, std::numbers::pi);
    const Point2 from = random.uniform(2.5, 6.0) * Point2{std::cos(angle_rad), std::sin(angle_rad)};
    const double way_rad = angle_rad + random.uniform(-0.6, 0.6);
    builder.wall({from, from + random.uniform(1.5, 4.0) * Point2{std::cos(way_rad), std::sin(way_rad)}});
  }
  builder.scatter(whole(10, 30, random), outline, {.any_angle = true});
  return builder.finished(kHallPassage_m, anywhere(random, true));
}

Layout wide_hall(double reach_m, Random& random) {
  LayoutBuilder builder{random};
  const double most_m = std::min(60.0, 3.5 * reach_m);
  const auto outline = rectangle({0.0, 0.0}, {random.uniform(0.7, 1.1) * most_m, random.uniform(0.6, 0.9) * most_m});
  builder.walls_round(outline);
  builder.scatter(whole(6, 18, random), outline, {.any_angle = random.uniform() < 0.5});
  return builder.finished(kHallPassage_m, anywhere(random));
}

}  // namespace

std::string_view name_of(LayoutKind kind) {
  constexpr std::string_view kNames[]{"blocks",    "rack aisles", "offices",  "corridors",
                                      "bent hall", "oblique",     "wide hall"};
  return kNames[static_cast<std::size_t>(kind)];
}

Layout drawn_layout(LayoutKind kind, double reach_m, Random random) {
  switch (kind) {
    case LayoutKind::kBlocks:
      return blocks(random);
    case LayoutKind::kRackAisles:
      return rack_aisles(random);
    case LayoutKind::kOffices:
      return offices(random);
    case LayoutKind::kCorridors:
      return corridors(random);
    case LayoutKind::kBentHall:
      return bent_hall(random);
    case LayoutKind::kOblique:
      return oblique(random);
    case LayoutKind::kWideHall:
      break;
  }
  return wide_hall(reach_m, random);
}

}  // namespace deltamap::simulation::drawn
