// SPDX-License-Identifier: Apache-2.0
// The changes of a simulated world under observation: how long each has been in the robot's view, and whether a map has
// followed it. Told of everything that happens, in order of time.
#pragma once

#include <array>
#include <numbers>
#include <optional>
#include <span>
#include <unordered_set>
#include <vector>

#include "simulation/movers/movers.hpp"
#include "simulation/scenario/scenario.hpp"
#include "simulation/score/change_score.hpp"
#include "simulation/score/standing.hpp"
#include "simulation/score/witness.hpp"

namespace deltamap::simulation::score {

/// A change under observation.
struct Watched {
  ScoredChange change;
  Witness witness;            ///< until it was overtaken
  bool is_told_apart = true;  ///< what its place was before had been in view: else nobody can tell that this is another
  bool was_in_view = false;   ///< for one look at least, until the same place changed again
  std::array<bool, 4> faces_that_show{};  ///< to the floor on which the robot stood: more than half of each
  std::optional<Witness> later{};         ///< from when it was overtaken on, until then
  bool is_replaced = false;               ///< the same place has changed again

  /// Each face that shows was seen for so long, until it was overtaken.
  [[nodiscard]] bool is_seen_all_around(double seen_least_s) const;
};

class ChangeWatch {
 public:
  ChangeWatch(const Scenario& scenario, const GridGeometry& geometry);

  void apply(const MoverEvent& event) { standing_.apply(event); }
  void apply(const Change& change, Timestamp time, const Point2& robot);

  /// What a perfect laser sees from there over so wide a field ahead: the world, and what stands or moves about in it.
  [[nodiscard]] std::vector<TrueBeam> view_from(const Pose2& map_from_laser, double range_m, int beams,
                                                const MovingSurfaces& about, double field_rad = std::numbers::pi) const;
  /// What stands about, as far as has been told.
  [[nodiscard]] MovingSurfaces standing() const { return standing_.surfaces(); }
  /// The view stood for so long.
  void look(std::span<const TrueBeam> view, double seconds, int face_beams);

  /// Counts the visible cells of each change and those that the map has right. `surfaces`: all that stands in the map
  /// now (drawn_surfaces).
  void judge(const OccupancyGrid& map, const OccupancyGrid& surfaces, const ChangeScoreParams& params);
  /// The same of one change.
  void judge(Watched& watched, const OccupancyGrid& map, const OccupancyGrid& surfaces,
             const ChangeScoreParams& params) const;

  /// Without what stands about.
  [[nodiscard]] const World& world() const { return world_; }
  /// With what stands about now.
  [[nodiscard]] World world_and_standing() const { return standing_.drawn_into(world_); }
  [[nodiscard]] std::vector<Watched>& watched() { return watched_; }

 private:
  void add(const ScoredChange& change, Witness witness, const std::unordered_set<std::size_t>& visible_surface);
  [[nodiscard]] bool is_told_apart(const ScoredChange& change) const;
  [[nodiscard]] std::unordered_set<std::size_t> visible_surface(const Box& box, const Point2& robot) const;
  [[nodiscard]] std::array<bool, 4> faces_that_show(const Box& box,
                                                    const std::unordered_set<std::size_t>& visible_surface) const;

  GridGeometry geometry_;
  SurfaceOptics optics_;
  World world_;
  Standing standing_;
  RayCaster surfaces_;
  std::vector<Watched> watched_;
};

/// The cells that any surface of the world passes through are occupied, all others unknown.
[[nodiscard]] OccupancyGrid drawn_surfaces(const World& world, const GridGeometry& geometry);

}  // namespace deltamap::simulation::score
