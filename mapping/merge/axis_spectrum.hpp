// SPDX-License-Identifier: Apache-2.0
// X- and Y-spectra of a map: how many contour cells lie in each column and row (paper Eq. 8–9). Correlating those of
// two maps turned alike tells the shift along each axis (Eq. 10).
#pragma once

#include <span>
#include <vector>

#include "mapping/merge/overlay_score.hpp"

namespace deltamap::mapping::merge {

/// Counts by whole cells; `counts[i]` belongs to cell `first + i`.
struct AxisSpectrum {
  int first = 0;
  std::vector<double> counts;
};
struct AxisSpectra {
  AxisSpectrum x;  ///< SX, Eq. 8
  AxisSpectrum y;  ///< SY, Eq. 9
};

/// Of a map's own columns and rows.
[[nodiscard]] AxisSpectra axis_spectra(const OccupancyGrid& map);
/// Of a local map turned about its middle (Eq. 7).
[[nodiscard]] AxisSpectra axis_spectra(std::span<const PointInCells> contour, double turn_rad);

/// The n best local maxima of CC(τ) = Σ_l S1(l + τ) S3(l) (Eq. 10), best first: whole cells by which to shift the
/// second.
[[nodiscard]] std::vector<int> best_shifts(const AxisSpectrum& one, const AxisSpectrum& other, int n);

}  // namespace deltamap::mapping::merge
