// SPDX-License-Identifier: Apache-2.0
#include "mapping/merge/axis_spectrum.hpp"

#include <algorithm>
#include <cmath>

#include "mapping/merge/spectrum_peak.hpp"

namespace deltamap::mapping::merge {
namespace {

constexpr int kApart_cells = 3;  // a wall a few cells thick makes one maximum

AxisSpectrum counted(const std::vector<int>& cells) {
  if (cells.empty()) return {};
  const auto [low, high] = std::minmax_element(cells.begin(), cells.end());
  AxisSpectrum spectrum{*low, std::vector<double>(static_cast<std::size_t>(*high - *low + 1), 0.0)};
  for (const int cell : cells) spectrum.counts[static_cast<std::size_t>(cell - *low)] += 1.0;
  return spectrum;
}

/// CC for every shift at which the two overlap; entry k belongs to shift k - (other.size() - 1) between their
/// beginnings.
std::vector<double> correlation(std::span<const double> one, std::span<const double> other) {
  std::vector<double> sums(one.size() + other.size() - 1, 0.0);
  for (std::size_t l = 0; l < other.size(); ++l) {
    if (other[l] == 0.0) continue;
    double* shifted = sums.data() + (other.size() - 1 - l);
    for (std::size_t i = 0; i < one.size(); ++i) shifted[i] += one[i] * other[l];
  }
  return sums;
}

}  // namespace

AxisSpectra axis_spectra(const OccupancyGrid& map) {
  AxisSpectra spectra{{0, std::vector<double>(static_cast<std::size_t>(map.width()), 0.0)},
                      {0, std::vector<double>(static_cast<std::size_t>(map.height()), 0.0)}};
  for (const Cell& cell : contour_cells(map)) {
    spectra.x.counts[static_cast<std::size_t>(cell.column)] += 1.0;
    spectra.y.counts[static_cast<std::size_t>(cell.row)] += 1.0;
  }
  return spectra;
}

AxisSpectra axis_spectra(std::span<const PointInCells> contour, double turn_rad) {
  const auto c = static_cast<float>(std::cos(turn_rad));
  const auto s = static_cast<float>(std::sin(turn_rad));
  std::vector<int> columns(contour.size());
  std::vector<int> rows(contour.size());
  for (std::size_t i = 0; i < contour.size(); ++i) {
    columns[i] = static_cast<int>(std::floor(c * contour[i].x - s * contour[i].y));
    rows[i] = static_cast<int>(std::floor(s * contour[i].x + c * contour[i].y));
  }
  return {counted(columns), counted(rows)};
}

std::vector<int> best_shifts(const AxisSpectrum& one, const AxisSpectrum& other, int n) {
  if (one.counts.empty() || other.counts.empty()) return {};
  const std::vector<double> sums = correlation(one.counts, other.counts);
  std::vector<int> shifts;
  for (const SpectrumPeak& peak : best_peaks(sums, n, kApart_cells, SpectrumEnds::kOpen)) {
    const int between_beginnings = static_cast<int>(peak.index) - static_cast<int>(other.counts.size() - 1);
    shifts.push_back(between_beginnings + one.first - other.first);
  }
  return shifts;
}

}  // namespace deltamap::mapping::merge
