// SPDX-License-Identifier: Apache-2.0
#include "mapping/merge/hough_spectrum.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <cstdint>
#include <numbers>

#include "core/geometry/angle.hpp"
#include "mapping/merge/spectrum_peak.hpp"

namespace deltamap::mapping::merge {
namespace {

float radius_of(std::span<const PointInCells> points) {
  float most2 = 0.0F;
  for (const PointInCells& point : points) most2 = std::max(most2, point.x * point.x + point.y * point.y);
  return std::sqrt(most2);
}

}  // namespace

std::vector<double> hough_spectrum(std::span<const PointInCells> contour) {
  static_assert(kHoughBins % 2 == 0, "the half turn must fall on a bin");
  // A point is shared between the two nearest bins of ρ: whole cells in one bin would make the lattice's own directions
  // stand out in every spectrum, whatever the walls do.
  constexpr std::uint32_t kWhole = 16;
  const float bound = std::ceil(radius_of(contour)) + 2.0F;
  std::vector<std::uint32_t> transform(static_cast<std::size_t>(2.0F * bound) + 2);
  std::vector<double> spectrum(kHoughBins, 0.0);
  const std::size_t half_turn = spectrum.size() / 2;
  for (std::size_t l = 0; l < half_turn; ++l) {
    const double theta_rad = 2.0 * std::numbers::pi * static_cast<double>(l) / kHoughBins;
    const auto c = static_cast<float>(std::cos(theta_rad));
    const auto s = static_cast<float>(std::sin(theta_rad));
    std::fill(transform.begin(), transform.end(), 0U);
    for (const PointInCells& point : contour) {
      const float rho = c * point.x + s * point.y + bound;
      const auto bin = static_cast<std::size_t>(rho);
      const auto share = static_cast<std::uint32_t>((rho - static_cast<float>(bin)) * kWhole);
      transform[bin] += kWhole - share;
      transform[bin + 1] += share;
    }
    double sum = 0.0;
    for (const std::uint32_t votes : transform) sum += static_cast<double>(votes) * static_cast<double>(votes);
    spectrum[l] = spectrum[l + half_turn] = sum / (kWhole * kWhole);
  }
  return spectrum;
}

std::vector<double> circular_correlation(std::span<const double> one, std::span<const double> other) {
  assert(one.size() == other.size() && "spectra must be sampled alike");
  const std::size_t count = one.size();
  std::vector<double> correlation(count, 0.0);
  for (std::size_t l = 0; l < count; ++l) {
    double sum = 0.0;
    for (std::size_t i = 0; i < count - l; ++i) sum += one[i] * other[i + l];
    for (std::size_t i = count - l; i < count; ++i) sum += one[i] * other[i + l - count];
    correlation[l] = sum;
  }
  return correlation;
}

std::vector<double> best_turns(std::span<const double> spectrum_one, std::span<const double> spectrum_other, int n,
                               bool between_bins) {
  // One half turn holds all there is; the other half repeats it.
  const std::size_t half_turn = spectrum_one.size() / 2;
  const std::vector<double> correlation =
      circular_correlation(spectrum_one.first(half_turn), spectrum_other.first(half_turn));
  const int apart = std::max(1, static_cast<int>(spectrum_one.size() / 120));  // 3°
  std::vector<double> turns;
  for (const SpectrumPeak& peak : best_peaks(correlation, n, apart, SpectrumEnds::kJoined)) {
    // other(i + l) fits one(i): the second map stands l bins ahead and has to be turned back by them.
    const double bin = static_cast<double>(peak.index) + (between_bins ? peak.offset : 0.0);
    const double turn_rad = -2.0 * std::numbers::pi * bin / static_cast<double>(spectrum_one.size());
    turns.push_back(wrapped_angle(turn_rad));
    turns.push_back(wrapped_angle(turn_rad + std::numbers::pi));
  }
  return turns;
}

}  // namespace deltamap::mapping::merge
