// SPDX-License-Identifier: Apache-2.0
// X- and Y-spectra of a map: how many contour cells lie in each column and row (paper Eq. 8–9). Correlating those of
// two maps turned alike tells the shift along each axis (Eq. 10).
#pragma once

#include <span>
#include <vector>

#include "mapping/merge/overlay_score.hpp"

namespace deltamap::mapping::merge {

/// Counts by pixels of an image in which a cell is `pixels_per_cell` wide; `counts[i]` belongs to pixel `first + i`.
struct AxisSpectrum {
  int first = 0;
  std::vector<float> counts;
};
struct AxisSpectra {
  AxisSpectrum x;  ///< SX, Eq. 8
  AxisSpectrum y;  ///< SY, Eq. 9
};

/// Of a map's own columns and rows.
[[nodiscard]] AxisSpectra axis_spectra(const OccupancyGrid& map, int pixels_per_cell);
/// Of a local map turned about its middle (Eq. 7), each cell drawn upright about its turned centre.
[[nodiscard]] AxisSpectra axis_spectra(std::span<const PointInCells> contour, double turn_rad, int pixels_per_cell);

/// The n best local maxima of CC(τ) = Σ_l S1(l + τ) S3(l) (Eq. 10), best first: whole pixels by which to shift the
/// second. Maxima nearer to a better one than `apart` pixels do not count.
[[nodiscard]] std::vector<int> best_shifts(const AxisSpectrum& one, const AxisSpectrum& other, int n, int apart);

}  // namespace deltamap::mapping::merge
