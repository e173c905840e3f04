// SPDX-License-Identifier: Apache-2.0
// The Hough spectrum of a map: HS(l) = Σ_i HT(i, l)² over the discretized Hough transform of its contour (paper
// §3.4.1). It turns with the map and does not feel shifts, so that correlating two spectra tells the rotation (Eq. 6).
#pragma once

#include <span>
#include <vector>

#include "mapping/merge/overlay_score.hpp"

namespace deltamap::mapping::merge {

/// θ_S: values of a spectrum.
inline constexpr int kHoughBins = 360;

/// θ_S values over [0°, 360°), 1 cell a bin of ρ. Lines have no direction: the period is 180°.
[[nodiscard]] std::vector<double> hough_spectrum(std::span<const PointInCells> contour);

/// CC(l) = Σ_i HS1(i) HS2(i + l), circular (Eq. 6; printed with HT for HS).
[[nodiscard]] std::vector<double> circular_correlation(std::span<const double> one, std::span<const double> other);

/// The turns of the second map onto the first, rad: the n best local maxima of Eq. 6, best first. Each comes twice,
/// 180° apart, for the spectrum cannot tell them. `between_bins`: place each maximum by a parabola through its
/// neighbours, else at its bin as published.
[[nodiscard]] std::vector<double> best_turns(std::span<const double> spectrum_one,
                                             std::span<const double> spectrum_other, int n, bool between_bins);

}  // namespace deltamap::mapping::merge
