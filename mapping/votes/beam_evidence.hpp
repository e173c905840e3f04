// SPDX-License-Identifier: Apache-2.0
// Holds the beams of a scan against the map, with the pose's uncertainty taken into account: a beam ends where the map
// has a surface, where it has none, or beyond something that the map has. It counts against a surface only where it
// would do so at every pose within the uncertainty.
#pragma once

#include <vector>

#include "core/grid/occupancy_grid.hpp"
#include "core/messages.hpp"
#include "mapping/votes/clear_space.hpp"

namespace deltamap::mapping::votes {

struct BeamEvidenceParams {
  double most_position_deviation_m = 0.3;    ///< poses worse than this say nothing
  double most_heading_deviation_rad = 0.07;  ///< poses worse than this say nothing (4°)
  double most_aside_m = 0.2;                 ///< a beam says nothing beyond where its own σ aside exceeds this
  double most_range_m = 25.0;                ///< a beam says nothing beyond this
};

struct BeamVerdict {
  Point2 from{0.0, 0.0};        ///< where the beam left the laser, map frame
  Point2 end{0.0, 0.0};         ///< where it ended, map frame; cut at the range to which it speaks
  double length_m = 0.0;        ///< from `from` to `end`; 0 where it says nothing: no range, or the pose too poor
  double interval_m = 0.0;      ///< half width of the interval of expected ranges
  bool ends_at_surface = true;  ///< false where the beam was cut
  bool ends_off_map = false;    ///< ends where the map has no surface, whatever it passed before
  std::vector<Cell> passed;     ///< the occupied cells that it has gone through at every pose within the uncertainty
};

/// Is the estimate good enough for its beams to say anything?
[[nodiscard]] bool speaks(const Estimate& estimate, double turn_rate_rad_per_s, const BeamEvidenceParams& params);

/// One verdict a beam, written over `verdicts` of the scan before (its memory is used again). `clear` is that of `map`.
[[nodiscard]] std::vector<BeamVerdict> beam_evidence(const OccupancyGrid& map, const ClearSpace& clear,
                                                     const TrackedScan& tracked, const BeamEvidenceParams& params,
                                                     std::vector<BeamVerdict> verdicts = {});

}  // namespace deltamap::mapping::votes
