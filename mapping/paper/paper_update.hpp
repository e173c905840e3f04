// SPDX-License-Identifier: Apache-2.0
// The map update as published (paper §3.3–3.4): align the scans of S(k), draw their local map, merge it by MA1 without
// a prior, and let its known cells override the map's. The acceptance threshold and the χ² test against the localizer's
// pose are ours: in a hall that repeats itself a merge without prior is sure and wrong.
#pragma once

#include "mapping/alignment/local_map.hpp"
#include "mapping/alignment/scan_alignment.hpp"
#include "mapping/merge/map_merge.hpp"
#include "mapping/scan_set/map_change.hpp"

namespace deltamap::mapping::paper {

/// The paper's hall is as symmetric as halls are: other poses that fit are left to the χ² test.
[[nodiscard]] inline merge::MapMergeParams paper_merge_params() {
  merge::MapMergeParams params;
  params.choice.refuse_ambiguous = false;
  params.choice.least_acceptance = 0.0;  // PaperUpdateParams::least_acceptance tells it apart
  return params;
}

struct PaperUpdateParams {
  alignment::ScanAlignmentParams alignment;
  alignment::LocalMapParams local_map;
  merge::MapMergeParams merge = paper_merge_params();
  std::size_t least_scans = 3;         ///< fewer draw no map
  double least_acceptance = 0.9;       ///< Eq. 11 of the local map and the map; [0, 1]
  bool refuse_implausible = true;      ///< the χ² test below (not published)
  double merge_deviation_cells = 1.0;  ///< σ of the merge's shift, along each axis
  double merge_deviation_rad = 0.009;  ///< σ of the merge's rotation (half a Hough bin)
};

/// `changes` holds the cells of `map` that the local map knows otherwise.
[[nodiscard]] scan_set::MapUpdate paper_update(const OccupancyGrid& map, const ScanSet& set,
                                               const PaperUpdateParams& params);

}  // namespace deltamap::mapping::paper
