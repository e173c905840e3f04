// SPDX-License-Identifier: Apache-2.0
#include "simulation/drawn/layout_builder.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "simulation/world/standing_room.hpp"

namespace deltamap::simulation::drawn {
namespace {

constexpr double kEmptyShare = 0.15;   // of the slots
constexpr double kBesideShare = 0.35;  // of the things, put beside another
constexpr int kTries = 40;             // for the place of one thing

Shape placed(const Shape& shape, const Pose2& map_from_layout) {
  if (const auto* line = std::get_if<Polyline>(&shape)) {
    Polyline moved = *line;
    for (Point2& point : moved.points) point = map_from_layout * point;
    return moved;
  }
  const Box& box = std::get<Box>(shape);
  return Box{map_from_layout * box.centre, box.width_m, box.height_m,
             wrapped_angle(map_from_layout.theta + box.theta_rad)};
}

}  // namespace

/// By how many of its sides lie to the right of the point.
bool is_within(const Point2& point, const std::vector<Point2>& outline) {
  bool inside = false;
  for (std::size_t i = 0; i < outline.size(); ++i) {
    const Point2& a = outline[i];
    const Point2& b = outline[(i + 1) % outline.size()];
    if ((a.y() > point.y()) == (b.y() > point.y())) continue;
    const double crossing_x = a.x() + (point.y() - a.y()) / (b.y() - a.y()) * (b.x() - a.x());
    if (point.x() < crossing_x) inside = !inside;
  }
  return inside;
}

std::vector<Point2> rectangle(const Point2& low, const Point2& high) {
  return {low, {high.x(), low.y()}, high, {low.x(), high.y()}};
}

double log_uniform(double least, double most, Random& random) {
  return least * std::pow(most / least, random.uniform());
}

double LayoutBuilder::size_m(double least_m, double most_m) { return log_uniform(least_m, most_m, random_); }

void LayoutBuilder::add(ObjectKind kind, Shape shape) {
  const int id = static_cast<int>(layout_.world.objects.size()) + 1;
  layout_.world.objects.push_back({id, kind, std::move(shape)});
}

void LayoutBuilder::wall(std::vector<Point2> points) { add(ObjectKind::kWall, Polyline{std::move(points)}); }

void LayoutBuilder::walls_round(std::vector<Point2> corners) {
  corners.push_back(corners.front());
  wall(std::move(corners));
}

void LayoutBuilder::slot(const Box& box) {
  layout_.slots.push_back(box);
  if (random_.uniform() >= kEmptyShare) add(ObjectKind::kContainer, box);
}

std::optional<Box> LayoutBuilder::thing_anywhere(const std::vector<Point2>& outline, const ScatterParams& params) {
  Point2 low = outline.front();
  Point2 high = outline.front();
  for (const Point2& corner : outline) {
    low = low.cwiseMin(corner);
    high = high.cwiseMax(corner);
  }
  const Point2 centre{random_.uniform(low.x(), high.x()), random_.uniform(low.y(), high.y())};
  const double turn_rad = params.any_angle ? random_.uniform(-std::numbers::pi, std::numbers::pi) : 0.0;
  const Box box{centre, size_m(params.least_m, params.most_m), size_m(params.least_m, params.most_m), turn_rad};
  if (!is_within(centre, outline) || !stands_free(grown(box, params.way_m), 0, layout_.world)) return std::nullopt;
  return box;
}

std::optional<Box> LayoutBuilder::thing_beside_another(const ScatterParams& params) {
  if (layout_.slots.empty()) return std::nullopt;
  const Box& other = layout_.slots[random_.index_below(static_cast<std::uint32_t>(layout_.slots.size()))];
  Box box = other;
  box.width_m = size_m(params.least_m, params.most_m);
  const double apart_m = 0.5 * (box.width_m + other.width_m) + random_.uniform(0.05, 0.4);
  box.centre = other.map_from_box() * Point2{random_.uniform() < 0.5 ? apart_m : -apart_m, 0.0};
  World others;
  std::copy_if(layout_.world.objects.begin(), layout_.world.objects.end(), std::back_inserter(others.objects),
               [&](const Object& object) {
                 const Box* its = std::get_if<Box>(&object.shape);
                 return its == nullptr || its->centre != other.centre;
               });
  const bool is_free = stands_free(box, 0, layout_.world) && stands_free(grown(box, params.way_m), 0, others);
  const bool hits_slot =
      std::any_of(layout_.slots.begin(), layout_.slots.end(), [&](const Box& slot) { return overlap(box, slot); });
  return is_free && !hits_slot ? std::optional{box} : std::nullopt;
}

void LayoutBuilder::scatter(int count, const std::vector<Point2>& outline, const ScatterParams& params) {
  for (int i = 0; i < count; ++i) {
    std::optional<Box> box;
    for (int attempt = 0; attempt < kTries && !box; ++attempt) {
      box = random_.uniform() < kBesideShare ? thing_beside_another(params) : thing_anywhere(outline, params);
    }
    if (box) slot(*box);
  }
}

void LayoutBuilder::lean(const Segment& wall, const Point2& inside, const ScatterParams& params, double depth_m) {
  constexpr double kFromWall_m = 0.03;
  const Point2 along = wall.to - wall.from;
  const double length_m = along.norm();
  const Box size{{0.0, 0.0},
                 size_m(params.least_m, params.most_m),
                 size_m(params.least_m, depth_m),
                 std::atan2(along.y(), along.x())};
  if (length_m < size.width_m + 0.2) return;
  Point2 inwards{-along.y() / length_m, along.x() / length_m};
  if (inwards.dot(inside - wall.from) < 0.0) inwards = -inwards;
  const double share = random_.uniform(0.5 * size.width_m + 0.1, length_m - 0.5 * size.width_m - 0.1) / length_m;
  Box box = size;
  box.centre = wall.from + share * along + (kFromWall_m + 0.5 * size.height_m) * inwards;
  const auto is_far = [&](const Object& object) {
    return object.kind == ObjectKind::kWall || !overlap(grown(box, params.way_m), object.shape);
  };
  Box room = box;  // before its front
  room.centre += 0.5 * (size.height_m + params.way_m) * inwards;
  room.height_m = params.way_m;
  const bool fits = std::all_of(layout_.world.objects.begin(), layout_.world.objects.end(), is_far) &&
                    stands_free(box, 0, layout_.world) && stands_free(room, 0, layout_.world);
  if (fits) slot(box);
}

Layout LayoutBuilder::finished(double passage_m, const Pose2& map_from_layout) {
  Layout done = std::move(layout_);
  for (Object& object : done.world.objects) object.shape = placed(object.shape, map_from_layout);
  for (Box& box : done.slots) box = std::get<Box>(placed(box, map_from_layout));
  done.passage_m = passage_m;
  return done;
}

}  // namespace deltamap::simulation::drawn
