// SPDX-License-Identifier: Apache-2.0
// Which of the fork-lift's changes the map has followed. The true world is rebuilt over time and looked at from the
// true poses, so that only what the robot could see is asked for.
#pragma once

#include <string>
#include <unordered_set>
#include <vector>

#include "core/grid/occupancy_grid.hpp"
#include "simulation/scenario/scenario.hpp"
#include "simulation/scenario/truth.hpp"

namespace deltamap::simulation::score {

struct ChangeScoreParams {
  double range_m = 32.0;         ///< as far as the robot sees, > 0
  int beams = 181;               ///< over the half circle ahead, >= 2
  double seen_least_s = 10.0;    ///< of one face, for a change to count
  int face_beams = 3;            ///< beams of one scan that make a face seen: one alone shows no extent; >= 1
  double found_share = 0.5;      ///< of its visible cells that must be right
  double longest_look_s = 0.25;  ///< that one pose stands for where the truth has a gap
};

/// A container that stands where nothing stood, or that stood where nothing stands. A shift is one of each.
struct ScoredChange {
  Timestamp time;
  ChangeKind kind = ChangeKind::kRemoved;  ///< what the fork-lift did
  bool appears = false;                    ///< new faces to find; else old faces to forget
  int id = 0;                              ///< of the container
  Box box;
  double seen_s = 0.0;            ///< the face seen longest
  bool is_overtaken = false;      ///< by a later change of the same place
  std::size_t visible_cells = 0;  ///< of the map, touched by beams
  std::size_t right_cells = 0;    ///< of those: occupied in the map, or a neighbour is; for the other kind: free
  bool is_eligible = false;       ///< seen long enough and not overtaken
  bool is_found = false;          ///< eligible, and enough cells are right

  [[nodiscard]] bool is_followed(double found_share) const {
    return visible_cells > 0 && static_cast<double>(right_cells) >= found_share * static_cast<double>(visible_cells);
  }
};

struct ChangeScore {
  std::vector<ScoredChange> changes;
  std::size_t eligible = 0;
  std::size_t found = 0;
  double ghosts_m2 = 0.0;        ///< occupied cells of the map farther than two cells from any true surface at the end
  double stale_ghosts_m2 = 0.0;  ///< of those: occupied in the start map already
};

/// `final_map` and `start_map` must have the same geometry; throws std::runtime_error otherwise.
[[nodiscard]] ChangeScore change_score(const Scenario& scenario, const Truth& truth, const OccupancyGrid& start_map,
                                       const OccupancyGrid& final_map, const ChangeScoreParams& params);

}  // namespace deltamap::simulation::score
