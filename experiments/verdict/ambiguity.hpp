// SPDX-License-Identifier: Apache-2.0
// Could anyone know where this robot is? An oracle that knows the truth and the world asks of every pose of the map
// whether what is seen along a path, begun there, would fit the map as well as at the true one. It shares nothing with
// the localizer: surfaces without noise and people, a search that overlooks no pose, and odds in place of particles.
#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <vector>

#include "experiments/verdict/map_distances.hpp"
#include "simulation/world/ray_caster.hpp"

namespace deltamap::experiments {

struct AmbiguityParams {
  double beam_step_rad = 0.0698;  ///< between the beams of a view, over half a circle; > 0 (4°)
  double fits_within_m = 0.15;    ///< of an obstacle of the map: the end of a beam fits
  double piece_m = 0.5;           ///< side of a piece of surface: all that is seen of one counts once; > 0
  double odds = 100.0;            ///< against a rival, from which the path is unambiguous; > 1
  double wrong_m = 0.5;           ///< a rival is farther than this from the truth...
  double wrong_rad = 0.1745;      ///< ...or turned by more than this (10°)
};

/// What a path shows: for every beam that ends on something within range where it came from and where it ended, m, in
/// the frame of the path's middle pose.
struct SeenPath {
  struct Beam {
    float from_x, from_y;
    float end_x, end_y;
    float from_lever, end_lever;  ///< from the frame's origin
    float weight;                 ///< one over the beams that end on the same piece of surface
    int piece_column, piece_row;  ///< of that piece, in the map
  };
  Pose2 map_from_middle;    ///< the truth
  std::vector<Beam> beams;  ///< neighbours far apart, so that any first part speaks for all
  double pieces = 0.0;      ///< of surface seen: sum of the weights
};
[[nodiscard]] SeenPath seen_path(const std::vector<Pose2>& map_from_laser, const simulation::RayCaster& world,
                                 double max_range_m, const AmbiguityParams& params);

struct Ambiguity {
  /// ln of the odds for the truth against the best other pose; told from 0 up to 1.5 ln(odds).
  double log_odds = 0.0;
  bool ambiguous = true;
  double pieces = 0.0;           ///< of surface seen
  double unexplained = 0.0;      ///< of them, at the true pose
  double changed_at_once = 1.0;  ///< pieces in a connected patch of the unexplained, about
  Pose2 map_from_rival;          ///< of the path's middle; the truth where there is no rival
  std::size_t judged_poses = 0;  ///< what it cost
};

class AmbiguityOracle {
 public:
  AmbiguityOracle(const OccupancyGrid& map, const AmbiguityParams& params) : map_{map}, params_{params} {}

  /// Whether the path, seen in this world, fits elsewhere in the map as well.
  [[nodiscard]] Ambiguity ambiguity(const std::vector<Pose2>& map_from_laser, const simulation::RayCaster& world,
                                    double max_range_m) const;
  /// Views from the first on after which the path stays unambiguous; 0 where it never is. `whole`: of all of it.
  [[nodiscard]] std::size_t views_needed(const std::vector<Pose2>& map_from_laser, const simulation::RayCaster& world,
                                         double max_range_m, const Ambiguity& whole) const;

 private:
  enum class Wanted : std::uint8_t { kBestRival, kAnyRival };
  [[nodiscard]] Ambiguity ambiguity(const std::vector<Pose2>& map_from_laser, const simulation::RayCaster& world,
                                    double max_range_m, Wanted wanted) const;

  MapDistances map_;
  AmbiguityParams params_;
};

}  // namespace deltamap::experiments
