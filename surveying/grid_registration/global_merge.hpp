// SPDX-License-Identifier: Apache-2.0
// Merges two maps without a prior, beyond the paper: rotations from the Hough spectra, every shift scored at once by
// correlating contour and free space (Fourier transform), the best brought to the end by closest lines. Refused where
// two poses fit nearly equally: a periodic hall is ambiguous.
#pragma once

#include "mapping/merge/map_merge.hpp"

namespace deltamap::surveying::grid_registration {

/// Both grids must have the same resolution. The pose is the best one found even where it is refused.
[[nodiscard]] mapping::merge::MapMerge global_merge(const OccupancyGrid& map, const OccupancyGrid& local);

}  // namespace deltamap::surveying::grid_registration
