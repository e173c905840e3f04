// SPDX-License-Identifier: Apache-2.0
// The map update of the evidence method. The scans of S(k) are placed on what is not in doubt, their rays are cast once
// more around the verdicts, and cells there that the beams clearly contradict are written. Unknown cells that beams
// have seen become free; free space that new surfaces enclose becomes unknown.
#pragma once

#include "core/grid/occupancy_grid.hpp"
#include "core/messages.hpp"
#include "mapping/redraw/placed_scans.hpp"
#include "mapping/scan_set/map_change.hpp"

namespace deltamap::mapping::redraw {

struct EvidenceUpdateParams {
  std::uint32_t least_scans = 2;        ///< fewer that fit are refused; >= 1
  double most_implausible_share = 0.5;  ///< of the scans that contradict the localizer; more are refused; [0, 1]
  double longest_m = 25.0;              ///< beams beyond do not draw
  int added_reach_cells = 4;            ///< cells so far from a verdict "occupied" may become occupied; >= 0
  int removed_reach_cells = 2;          ///< cells so far from a verdict "free" may become free; >= 0
  double most_enclosed_m2 = 15.0;       ///< larger pieces of floor that new surfaces close off stay free; >= 0
  double occupied_hit_share = 0.3;      ///< a cell is occupied from this share of hits on, …
  int occupied_hits = 2;                ///< … and so many hits
  double free_hit_share = 0.1;          ///< an occupied or unknown cell becomes free up to this share of hits, …
  int free_passes = 3;                  ///< … and from so many passes on that end clearly behind it
  int least_group_cells = 3;            ///< smaller groups of new occupied cells that touch nothing are left out
  double least_acceptance = 0.8;        ///< Eq. 11 of local map and updated map below which the update is refused
  PlacementParams placement;
};

[[nodiscard]] scan_set::MapUpdate evidence_update(const OccupancyGrid& map, const ScanSet& set,
                                                  const EvidenceUpdateParams& params);

}  // namespace deltamap::mapping::redraw
