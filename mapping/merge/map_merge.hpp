// SPDX-License-Identifier: Apache-2.0
// Merges two maps without a prior as published (paper §3.4, after Carpin, "Fast and accurate map merging for
// multi-robot systems", 2008): rotations from the Hough spectra, shifts from the axis spectra, each candidate scored by
// Eq. 11. MA1 is that; MA2 to MA4 also try neighbours of its candidates (§3.4.2).
#pragma once

#include <cstdint>
#include <vector>

#include "core/grid/occupancy_grid.hpp"
#include "mapping/merge/merge_refusal.hpp"
#include "mapping/merge/overlay_score.hpp"

namespace deltamap::mapping::merge {

enum class MergeMethod : std::uint8_t {
  kMa1,  ///< as published
  kMa2,  ///< candidates turned by ±0.5°, step 0.25°
  kMa3,  ///< candidates turned by ±1°, step 0.25°
  kMa4   ///< candidates turned by ±0.25°, step 0.25°, and shifted by ±1 cell along each axis
};

/// How a merge without prior picks among scored poses, and when it refuses.
struct ChoiceParams {
  double least_overlap = 0.15;     ///< share of the local map's known cells that must lie on known cells; [0, 1]
  double least_agreement = 0.6;    ///< share of its contour on known cells that must be found again; [0, 1]
  double least_acceptance = 0.9;   ///< Eq. 11; [0, 1]
  double surface_margin = 0.6;     ///< poses that find less than this share of the best one's surface do not compete:
                                   ///< maps that share two thirds find no more at the true pose
  bool refuse_ambiguous = true;    ///< refuse where a clearly different pose fits nearly as well (not published)
  double ambiguity_margin = 0.02;  ///< what nearly means: in Eq. 11, and in shares of the contour; [0, 1]
};

struct MapMergeParams {
  MergeMethod method = MergeMethod::kMa1;
  int rotations = 4;        ///< n: maxima of Eq. 6; each is also tried half a turn on
  int shifts = 40;          ///< maxima of Eq. 10 along each axis
  int pixels_per_cell = 2;  ///< of the images whose X- and Y-spectra are taken; >= 1
  ChoiceParams choice;
};

struct MapMerge {
  MergeRefusal refusal = MergeRefusal::kNone;
  Pose2 map_from_local;
  OverlayScore score;  ///< at that pose

  [[nodiscard]] bool accepted() const { return refusal == MergeRefusal::kNone; }
};

/// Both grids must have the same resolution. The pose is the best one found even where it is refused.
[[nodiscard]] MapMerge map_merge(const OccupancyGrid& map, const OccupancyGrid& local, const MapMergeParams& params);

/// A pose that competes.
struct ScoredMotion {
  CellMotion motion;
  OverlayScore score;
};

/// Picks one; shared by the merges without prior.
[[nodiscard]] MapMerge chosen(const std::vector<ScoredMotion>& candidates, const OccupancyGrid& map,
                              const LocalCells& local, const ChoiceParams& params);

}  // namespace deltamap::mapping::merge
