// SPDX-License-Identifier: Apache-2.0
// Merges two maps without a prior, beyond the paper: rotations from the Hough spectra, every shift scored at once by
// correlating contour and free space (Fourier transform), the best brought to the end by closest lines. Refused where
// two poses fit nearly equally: a periodic hall is ambiguous.
#pragma once

#include "mapping/merge/map_merge.hpp"

namespace deltamap::mapping::grid_registration {

/// With the pose brought to the end, less may be wrong than at the published merges' half degrees. Maps of one place,
/// bare and furnished, agreed in 0.86 of the contour and more; racks one bay off in 0.76 and less.
[[nodiscard]] inline merge::ChoiceParams stricter_choice() {
  merge::ChoiceParams choice;
  choice.least_overlap = 0.2;
  choice.least_agreement = 0.8;
  choice.least_acceptance = 0.93;
  return choice;
}

struct GlobalMergeParams {
  int hough_bins = 360;   ///< over a turn; even
  int rotations = 6;      ///< maxima of Eq. 6; each is also tried half a turn on
  int shifts = 12;        ///< best shifts for each rotation: racks repeat
  double pixel_m = 0.4;   ///< of the correlated pictures, at least; > 0
  int most_pixels = 320;  ///< along a side of the correlated pictures; larger maps are shrunk further
  merge::ChoiceParams choice = stricter_choice();
};

/// Both grids must have the same resolution. The pose is the best one found even where it is refused.
[[nodiscard]] merge::MapMerge global_merge(const OccupancyGrid& map, const OccupancyGrid& local,
                                           const GlobalMergeParams& params);

}  // namespace deltamap::mapping::grid_registration
