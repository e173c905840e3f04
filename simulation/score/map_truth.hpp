// SPDX-License-Identifier: Apache-2.0
// What a map could know at best. Follows the true world and what the robot's beams have touched of it: the perfect
// mapper has every touched cell right as of its last touch, and M_0 everywhere else.
#pragma once

#include <span>

#include "simulation/scenario/scenario.hpp"
#include "simulation/score/map_score.hpp"
#include "simulation/score/witness.hpp"

namespace deltamap::simulation::score {

class MapTruth {
 public:
  MapTruth(const Scenario& scenario, const OccupancyGrid& first_map);

  /// The world has become so. Whatever stands about in passing is not part of it.
  void see(const World& world);
  void touch(std::span<const TrueBeam> view);

  /// What a laser can see of the world: surfaces, floor; the inside of things and what lies behind walls is unknown.
  [[nodiscard]] const OccupancyGrid& visible() const { return visible_; }
  /// The same, the inside of containers and posts occupied.
  [[nodiscard]] OccupancyGrid solid() const;
  [[nodiscard]] const OccupancyGrid& perfect() const { return perfect_; }
  /// Cells that a beam has ever touched and their neighbours, the sweep of doors left out.
  [[nodiscard]] CellMask seen() const;
  /// Cells that the last beam which touched them went through.
  [[nodiscard]] const CellMask& last_passed() const { return last_passed_; }
  /// The leaf of a door sweeps over the cell.
  [[nodiscard]] bool is_at_door(std::size_t cell) const { return of_doors_[cell] != 0; }
  /// Surfaces of M_0 that never move and send beams back: walls and posts, no glass, no doors.
  [[nodiscard]] CellMask lasting() const { return surfaces_of(Material::kSolid); }
  /// Panes and what is wrapped.
  [[nodiscard]] CellMask seen_through() const;
  /// The pieces of the outer wall in the map: mean distance by which each has moved to its right, m; NaN where it is
  /// not drawn. Of a world whose first wall is not closed, the sides of the rectangle around it.
  [[nodiscard]] std::vector<double> wall_drift(const OccupancyGrid& first, const OccupancyGrid& map) const;

 private:
  [[nodiscard]] CellMask surfaces_of(Material material) const;
  [[nodiscard]] Point2 uncovered_floor() const;

  Point2 floor_;  // where the robot started
  World world_;
  std::vector<Segment> outer_;
  std::vector<DoorParams> doors_;
  OccupancyGrid visible_;
  OccupancyGrid perfect_;
  CellMask touched_;
  CellMask last_passed_;
  CellMask of_doors_;
};

}  // namespace deltamap::simulation::score
