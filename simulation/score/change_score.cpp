// SPDX-License-Identifier: Apache-2.0
#include "simulation/score/change_score.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>

#include "simulation/score/standing.hpp"
#include "simulation/score/witness.hpp"
#include "simulation/start_map.hpp"
#include "simulation/surface_optics.hpp"

namespace deltamap::simulation::score {
namespace {

constexpr double kSamePlace_m = 0.05;  // places this near to each other count as one

/// A change under observation.
struct Watched {
  ScoredChange change;
  Witness witness;
};

/// The true world at a moment of the rebuilt past, and everything that has changed until then.
class Retrospect {
 public:
  Retrospect(const Scenario& scenario, const GridGeometry& geometry)
      : geometry_{geometry}, optics_{scenario.laser.optics.surfaces}, world_{scenario.world}, standing_{scenario} {}

  void apply(const TruthEvent& truth) { standing_.apply(truth.event); }

  void apply(const TruthChange& truth, const Point2& robot) {
    const Change& change = truth.change;
    if (change.kind != ChangeKind::kAdded) {
      const Box& left = change.from.value_or(change.box);
      add({truth.time, change.kind, false, change.id, left},
          Witness::of_disappearance(left, geometry_, visible_surface(left, robot)));
    }
    world_ = changed(world_, change);
    surfaces_ = RayCaster{world_};
    if (change.kind != ChangeKind::kRemoved) {
      add({truth.time, change.kind, true, change.id, change.box},
          Witness::of_appearance(change.id, change.box, geometry_));
    }
  }

  void look(const Pose2& map_from_laser, double seconds, const ChangeScoreParams& params) {
    const double step_rad = std::numbers::pi / (params.beams - 1);
    const auto sees_through = [&](const RayHit& met) {
      return met.material == Material::kGlass && passes_glass(met, optics_);
    };
    for (int i = 0; i < params.beams; ++i) {
      const double bearing_rad = map_from_laser.theta - 0.5 * std::numbers::pi + i * step_rad;
      const auto hit = cast_through(surfaces_, map_from_laser.position(), bearing_rad, params.range_m,
                                    standing_.surfaces(), sees_through);
      const TrueBeam beam{map_from_laser.position(), bearing_rad, hit ? hit->range_m : params.range_m, hit};
      for (Watched& watched : watched_) {
        if (!watched.change.is_overtaken) watched.witness.look(beam);
      }
    }
    for (Watched& watched : watched_) watched.witness.end_look(seconds, params.face_beams);
  }

  /// With what stands about now.
  [[nodiscard]] World world() const { return standing_.drawn_into(world_); }
  [[nodiscard]] std::vector<Watched>& watched() { return watched_; }

 private:
  void add(const ScoredChange& change, Witness witness) {
    for (Watched& earlier : watched_) {
      if (earlier.change.time < change.time && overlap(grown(earlier.change.box, kSamePlace_m), change.box)) {
        earlier.change.is_overtaken = true;
      }
    }
    watched_.push_back({change, std::move(witness)});
  }

  /// The cells of a box's surface that could be seen from the floor on which the robot stands.
  [[nodiscard]] std::unordered_set<std::size_t> visible_surface(const Box& box, const Point2& robot) const {
    const OccupancyGrid seen = surveyed_map(world_, robot, geometry_);
    std::unordered_set<std::size_t> cells;
    for (const Cell cell : surface_cells(box, geometry_)) {
      if (seen[cell] == CellState::kOccupied) cells.insert(geometry_.index_of(cell));
    }
    return cells;
  }

  GridGeometry geometry_;
  SurfaceOptics optics_;
  World world_;
  Standing standing_;
  RayCaster surfaces_{world_};
  std::vector<Watched> watched_;
};

bool has_occupied_neighbour(const OccupancyGrid& map, Cell cell) {
  for (int row = -1; row <= 1; ++row) {
    for (int column = -1; column <= 1; ++column) {
      if (map.at({cell.column + column, cell.row + row}) == CellState::kOccupied) return true;
    }
  }
  return false;
}

/// Counts the visible cells of a change and those that the map has right.
void judge(Watched& watched, const OccupancyGrid& map, const OccupancyGrid& final_surfaces,
           const ChangeScoreParams& params) {
  ScoredChange& change = watched.change;
  for (const std::size_t index : watched.witness.touched()) {
    const Cell cell = map.geometry().cell_of(index);
    // A cell beside something else that stands there now says nothing about what has gone.
    if (!change.appears && has_occupied_neighbour(final_surfaces, cell)) continue;
    ++change.visible_cells;
    const bool is_right = change.appears ? has_occupied_neighbour(map, cell) : map[cell] == CellState::kFree;
    if (is_right) ++change.right_cells;
  }
  change.seen_s = watched.witness.longest_seen_s();
  change.is_eligible = !change.is_overtaken && change.seen_s >= params.seen_least_s && change.visible_cells > 0;
  change.is_found = change.is_eligible && static_cast<double>(change.right_cells) >=
                                              params.found_share * static_cast<double>(change.visible_cells);
}

OccupancyGrid drawn_surfaces(const World& world, const GridGeometry& geometry) {
  OccupancyGrid grid{geometry};
  for (const Object& object : world.objects) {
    for (const Cell cell : surface_cells(object.shape, geometry)) grid.set(cell, CellState::kOccupied);
  }
  return grid;
}

void count_ghosts(const RayCaster& surfaces, const OccupancyGrid& start_map, const OccupancyGrid& map,
                  ChangeScore& score) {
  const double cell_m2 = map.resolution_m() * map.resolution_m();
  const double near_m = 2.0 * map.resolution_m() + 1e-6;
  for (std::size_t i = 0; i < map.geometry().cell_count(); ++i) {
    const Cell cell = map.geometry().cell_of(i);
    if (map[cell] != CellState::kOccupied || surfaces.nearest_surface(map.geometry().centre_of(cell), near_m)) continue;
    score.ghosts_m2 += cell_m2;
    if (start_map[cell] == CellState::kOccupied) score.stale_ghosts_m2 += cell_m2;
  }
}

}  // namespace

ChangeScore change_score(const Scenario& scenario, const Truth& truth, const OccupancyGrid& start_map,
                         const OccupancyGrid& final_map, const ChangeScoreParams& params) {
  if (!(start_map.geometry() == final_map.geometry())) {
    throw std::runtime_error("the start map and the final map differ in size, resolution or origin");
  }
  Retrospect past{scenario, final_map.geometry()};
  auto event = truth.events.begin();
  auto change = truth.changes.begin();
  for (auto pose = truth.poses.begin(); pose != truth.poses.end(); ++pose) {
    for (; change != truth.changes.end() && change->time <= pose->time; ++change)
      past.apply(*change, pose->map_from_robot.position());
    for (; event != truth.events.end() && event->time <= pose->time; ++event) past.apply(*event);
    const auto next = std::next(pose);
    if (next == truth.poses.end() || past.watched().empty()) continue;
    const double lasts_s = std::min(params.longest_look_s, seconds(next->time - pose->time));
    past.look(pose->map_from_robot * scenario.laser.optics.robot_from_laser, lasts_s, params);
  }
  for (; change != truth.changes.end(); ++change) past.apply(*change, truth.poses.back().map_from_robot.position());
  for (; event != truth.events.end(); ++event) past.apply(*event);

  ChangeScore score;
  const World world_at_end = past.world();
  const OccupancyGrid final_surfaces = drawn_surfaces(world_at_end, final_map.geometry());
  for (Watched& watched : past.watched()) {
    judge(watched, final_map, final_surfaces, params);
    score.eligible += watched.change.is_eligible ? 1 : 0;
    score.found += watched.change.is_found ? 1 : 0;
    score.changes.push_back(watched.change);
  }
  count_ghosts(RayCaster{world_at_end}, start_map, final_map, score);
  return score;
}

}  // namespace deltamap::simulation::score
