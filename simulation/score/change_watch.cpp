// SPDX-License-Identifier: Apache-2.0
#include "simulation/score/change_watch.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "core/grid/near_occupied.hpp"
#include "simulation/robot/surface_optics.hpp"
#include "simulation/scenario/start_map.hpp"

namespace deltamap::simulation::score {
namespace {

constexpr double kSamePlace_m = 0.05;  // places this near to each other count as one

bool is_same_place(const Box& a, const Box& b) {
  return (a.centre - b.centre).norm() <= kSamePlace_m && std::abs(a.width_m - b.width_m) <= kSamePlace_m &&
         std::abs(a.height_m - b.height_m) <= kSamePlace_m;
}

}  // namespace

ChangeWatch::ChangeWatch(const Scenario& scenario, const GridGeometry& geometry)
    : geometry_{geometry},
      optics_{scenario.laser.optics.surfaces},
      world_{scenario.world},
      standing_{scenario},
      surfaces_{world_} {}

void ChangeWatch::apply(const Change& change, Timestamp time, const Point2& robot) {
  if (change.kind != ChangeKind::kAdded) {
    const Box& left = change.from.value_or(change.box);
    const std::unordered_set<std::size_t> visible = visible_surface(left, robot);
    add({time, change.kind, false, change.id, left}, Witness::of_disappearance(left, geometry_, visible), visible);
  }
  world_ = changed(world_, change);
  surfaces_ = RayCaster{world_};
  if (change.kind != ChangeKind::kRemoved) {
    add({time, change.kind, true, change.id, change.box}, Witness::of_appearance(change.id, change.box, geometry_),
        visible_surface(change.box, robot));
  }
}

void ChangeWatch::add(const ScoredChange& change, Witness witness,
                      const std::unordered_set<std::size_t>& visible_surface) {
  const bool is_told = is_told_apart(change);
  for (Watched& earlier : watched_) {
    if (earlier.change.time >= change.time || !overlap(grown(earlier.change.box, kSamePlace_m), change.box)) continue;
    if (!earlier.change.is_overtaken) earlier.later = earlier.witness;
    earlier.change.is_overtaken = true;
    earlier.is_replaced = earlier.is_replaced || is_same_place(earlier.change.box, change.box);
  }
  Watched watched{change, std::move(witness), is_told};
  watched.faces_that_show = faces_that_show(change.box, visible_surface);
  watched_.push_back(std::move(watched));
}

/// Against what was in view last of the place; else against what it was at the beginning.
bool ChangeWatch::is_told_apart(const ScoredChange& change) const {
  std::optional<bool> stood;
  for (const Watched& earlier : watched_) {
    if (earlier.change.time >= change.time || !is_same_place(earlier.change.box, change.box)) continue;
    if (!stood) stood = !earlier.change.appears;
    if (earlier.was_in_view) stood = earlier.change.appears;
  }
  return !stood || *stood != change.appears;
}

/// The cells of a box's surface that could be seen from the floor on which the robot stands.
std::unordered_set<std::size_t> ChangeWatch::visible_surface(const Box& box, const Point2& robot) const {
  const OccupancyGrid seen = surveyed_map(world_, robot, geometry_);
  std::unordered_set<std::size_t> cells;
  for (const Cell cell : surface_cells(box, geometry_)) {
    if (seen.at(cell) == CellState::kOccupied) cells.insert(geometry_.index_of(cell));
  }
  return cells;
}

std::array<bool, 4> ChangeWatch::faces_that_show(const Box& box,
                                                 const std::unordered_set<std::size_t>& visible_surface) const {
  const std::array<Segment, 4> sides = faces(box);
  std::array<double, 4> shown_m{};
  for (const Cell cell : surface_cells(box, geometry_)) {
    if (!visible_surface.contains(geometry_.index_of(cell))) continue;
    const Point2 place = geometry_.centre_of(cell);
    const auto nearer = [&](const Segment& a, const Segment& b) {
      return distance_between(place, a) < distance_between(place, b);
    };
    const auto side = std::min_element(sides.begin(), sides.end(), nearer) - sides.begin();
    shown_m.at(static_cast<std::size_t>(side)) += geometry_.resolution_m;
  }
  std::array<bool, 4> shows{};
  for (std::size_t side = 0; side < sides.size(); ++side)
    shows[side] = shown_m[side] > 0.5 * (sides[side].to - sides[side].from).norm();
  return shows;
}

bool Watched::is_seen_all_around(double seen_least_s) const {
  for (std::size_t face = 0; face < faces_that_show.size(); ++face) {
    if (faces_that_show[face] && witness.faces_seen_s()[face] < seen_least_s) return false;
  }
  return true;
}

std::vector<TrueBeam> ChangeWatch::view_from(const Pose2& map_from_laser, double range_m, int beams,
                                             const MovingSurfaces& about, double field_rad) const {
  const double step_rad = field_rad / (beams - 1);
  const auto sees_through = [&](const RayHit& met) {
    return met.material == Material::kGlass && passes_glass(met, optics_);
  };
  std::vector<TrueBeam> view;
  for (int i = 0; i < beams; ++i) {
    const double bearing_rad = map_from_laser.theta - 0.5 * field_rad + i * step_rad;
    const auto hit = cast_through(surfaces_, map_from_laser.position(), bearing_rad, range_m, about, sees_through);
    view.push_back({map_from_laser.position(), bearing_rad, hit ? hit->range_m : range_m, hit});
  }
  return view;
}

void ChangeWatch::look(std::span<const TrueBeam> view, double seconds, int face_beams) {
  for (Watched& watched : watched_) {
    if (watched.is_replaced || (watched.change.is_overtaken && watched.was_in_view)) continue;
    Witness& witness = watched.later ? *watched.later : watched.witness;
    for (const TrueBeam& beam : view) witness.look(beam);
    witness.end_look(seconds, face_beams);
    watched.was_in_view = witness.longest_seen_s() > 0.0;
  }
}

void ChangeWatch::judge(const OccupancyGrid& map, const OccupancyGrid& surfaces, const ChangeScoreParams& params) {
  for (Watched& watched : watched_) judge(watched, map, surfaces, params);
}

void ChangeWatch::judge(Watched& watched, const OccupancyGrid& map, const OccupancyGrid& surfaces,
                        const ChangeScoreParams& params) const {
  ScoredChange& change = watched.change;
  change.visible_cells = 0;
  change.right_cells = 0;
  for (const std::size_t index : watched.witness.touched()) {
    const Cell cell = geometry_.cell_of(index);
    // A cell beside something else that stands there now says nothing about what has gone.
    if (!change.appears && has_occupied_within(surfaces, cell, 1)) continue;
    ++change.visible_cells;
    const bool is_right = change.appears ? has_occupied_within(map, cell, 1) : map[cell] == CellState::kFree;
    if (is_right) ++change.right_cells;
  }
  change.seen_s = watched.witness.longest_seen_s();
  change.is_eligible = !change.is_overtaken && change.seen_s >= params.seen_least_s && change.visible_cells > 0;
  change.is_found = change.is_eligible && change.is_followed(params.found_share);
}

OccupancyGrid drawn_surfaces(const World& world, const GridGeometry& geometry) {
  OccupancyGrid grid{geometry};
  for (const Object& object : world.objects) {
    for (const Cell cell : surface_cells(object.shape, geometry)) grid.set(cell, CellState::kOccupied);
  }
  return grid;
}

}  // namespace deltamap::simulation::score
