// SPDX-License-Identifier: Apache-2.0
#include "mapping/merge/axis_spectrum.hpp"

#include <algorithm>
#include <cmath>

#include "mapping/merge/spectrum_peak.hpp"

namespace deltamap::mapping::merge {
namespace {

/// Each entry of `firsts` is the first of `pixels_per_cell` pixels that a cell covers.
AxisSpectrum counted(const std::vector<int>& firsts, int pixels_per_cell) {
  if (firsts.empty()) return {};
  const auto [low, high] = std::minmax_element(firsts.begin(), firsts.end());
  AxisSpectrum spectrum{*low, std::vector<float>(static_cast<std::size_t>(*high - *low + pixels_per_cell), 0.0F)};
  for (const int first : firsts) {
    for (int i = 0; i < pixels_per_cell; ++i) spectrum.counts[static_cast<std::size_t>(first - *low + i)] += 1.0F;
  }
  return spectrum;
}

/// CC for every shift at which the two overlap; entry k belongs to shift k - (other.size() - 1) between their
/// beginnings.
std::vector<float> correlation(std::span<const float> one, std::span<const float> other) {
  std::vector<float> sums(one.size() + other.size() - 1, 0.0F);
  for (std::size_t l = 0; l < other.size(); ++l) {
    if (other[l] == 0.0F) continue;
    float* shifted = sums.data() + (other.size() - 1 - l);
    for (std::size_t i = 0; i < one.size(); ++i) shifted[i] += one[i] * other[l];
  }
  return sums;
}

}  // namespace

AxisSpectra axis_spectra(const OccupancyGrid& map, int pixels_per_cell) {
  std::vector<int> columns;
  std::vector<int> rows;
  for (const Cell& cell : contour_cells(map)) {
    columns.push_back(pixels_per_cell * cell.column);
    rows.push_back(pixels_per_cell * cell.row);
  }
  return {counted(columns, pixels_per_cell), counted(rows, pixels_per_cell)};
}

AxisSpectra axis_spectra(std::span<const PointInCells> contour, double turn_rad, int pixels_per_cell) {
  const auto scale = static_cast<float>(pixels_per_cell);
  const auto c = scale * static_cast<float>(std::cos(turn_rad));
  const auto s = scale * static_cast<float>(std::sin(turn_rad));
  const float to_first = 0.5F * (1.0F - scale);  // from the pixel that holds the centre, or between two
  std::vector<int> columns(contour.size());
  std::vector<int> rows(contour.size());
  for (std::size_t i = 0; i < contour.size(); ++i) {
    columns[i] = rounded_down(c * contour[i].x - s * contour[i].y + to_first);
    rows[i] = rounded_down(s * contour[i].x + c * contour[i].y + to_first);
  }
  return {counted(columns, pixels_per_cell), counted(rows, pixels_per_cell)};
}

std::vector<int> best_shifts(const AxisSpectrum& one, const AxisSpectrum& other, int n, int apart) {
  if (one.counts.empty() || other.counts.empty()) return {};
  const std::vector<float> sums = correlation(one.counts, other.counts);
  const std::vector<double> signal(sums.begin(), sums.end());
  std::vector<int> shifts;
  for (const SpectrumPeak& peak : best_peaks(signal, n, apart, SpectrumEnds::kOpen)) {
    const int between_beginnings = static_cast<int>(peak.index) - static_cast<int>(other.counts.size() - 1);
    shifts.push_back(between_beginnings + one.first - other.first);
  }
  return shifts;
}

}  // namespace deltamap::mapping::merge
