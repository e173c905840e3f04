// SPDX-License-Identifier: Apache-2.0
// Classifies the beams of a scan against the map, with the pose's uncertainty taken into account: a beam ends where the
// map has a surface (consistent), before it (short), or beyond something that the map has (through). It counts against
// a surface only where it would do so at every pose within the uncertainty.
#pragma once

#include <cstdint>
#include <vector>

#include "core/messages.hpp"
#include "core/occupancy_grid.hpp"
#include "mapping/votes/clear_space.hpp"

namespace deltamap::mapping::votes {

struct BeamEvidenceParams {
  double deviations = 2.0;                     ///< half width of the interval in σ; > 0
  double least_position_deviation_m = 0.01;    ///< floor added to the pose's σ: estimates are too sure of themselves
  double least_heading_deviation_rad = 0.004;  ///< floor added to the heading's σ
  double range_deviation_m = 0.015;            ///< of the laser, σ_r
  double clock_deviation_s = 0.01;             ///< times the turn rate is added to the heading's σ
  double most_position_deviation_m = 0.3;      ///< poses worse than this say nothing
  double most_heading_deviation_rad = 0.07;    ///< poses worse than this say nothing (4°)
  double most_aside_m = 0.2;                   ///< a beam says nothing beyond where its own σ aside exceeds this
  double most_range_m = 25.0;                  ///< a beam says nothing beyond this
  double beyond_m = 0.2;  ///< a beam must end this far behind what it went through, besides the interval
};

enum class BeamClass : std::uint8_t {
  kSilent,      ///< no range, too far, or the pose too poor
  kConsistent,  ///< ends at a surface of the map
  kShort,       ///< ends where the map has nothing: on a free cell
  kUnknown,     ///< ends where the map has nothing: on an unknown cell
  kThrough      ///< has passed a surface of the map for every pose within the uncertainty
};

struct BeamVerdict {
  BeamClass what = BeamClass::kSilent;
  Point2 from{0.0, 0.0};        ///< where the beam left the laser, map frame
  Point2 end{0.0, 0.0};         ///< where it ended, map frame; cut at the range to which it speaks
  double length_m = 0.0;        ///< from `from` to `end`
  double interval_m = 0.0;      ///< half width of the interval of expected ranges: `deviations` · σ at the end
  bool ends_at_surface = true;  ///< false where the beam was cut
  bool ends_off_map = false;    ///< ends where the map has no surface, whatever it passed before
  std::vector<Cell> passed;     ///< kThrough: the occupied cells that it speaks against
};

/// Is the estimate good enough for its beams to say anything?
[[nodiscard]] bool speaks(const Estimate& estimate, double turn_rate_rad_per_s, const BeamEvidenceParams& params);

/// One verdict a beam, written over `verdicts` of the scan before (its memory is used again). `clear` is that of `map`.
[[nodiscard]] std::vector<BeamVerdict> beam_evidence(const OccupancyGrid& map, const ClearSpace& clear,
                                                     const TrackedScan& tracked, const BeamEvidenceParams& params,
                                                     std::vector<BeamVerdict> verdicts = {});

}  // namespace deltamap::mapping::votes
