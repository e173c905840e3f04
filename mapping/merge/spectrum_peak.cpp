// SPDX-License-Identifier: Apache-2.0
#include "mapping/merge/spectrum_peak.hpp"

#include <algorithm>
#include <cstddef>

namespace deltamap::mapping::merge {

std::vector<SpectrumPeak> best_peaks(std::span<const double> signal, int n, int apart, SpectrumEnds ends) {
  std::vector<SpectrumPeak> peaks;
  const auto count = static_cast<std::ptrdiff_t>(signal.size());
  const auto sample = [&](std::ptrdiff_t index) {
    if (index >= 0 && index < count) return signal[static_cast<std::size_t>(index)];
    return ends == SpectrumEnds::kOpen ? 0.0 : signal[static_cast<std::size_t>((index + count) % count)];
  };
  for (std::ptrdiff_t i = 0; i < count; ++i) {
    const double here = sample(i);
    bool is_peak = here > 0.0;
    for (std::ptrdiff_t k = 1; is_peak && k <= apart && k < count; ++k) {
      is_peak = here > sample(i - k) && here >= sample(i + k);
    }
    if (!is_peak) continue;
    const double bend = sample(i - 1) - 2.0 * here + sample(i + 1);
    peaks.push_back(
        {static_cast<std::size_t>(i), bend < 0.0 ? 0.5 * (sample(i - 1) - sample(i + 1)) / bend : 0.0, here});
  }
  std::stable_sort(peaks.begin(), peaks.end(), [](const auto& a, const auto& b) { return a.value > b.value; });
  if (peaks.size() > static_cast<std::size_t>(std::max(0, n))) peaks.resize(static_cast<std::size_t>(std::max(0, n)));
  return peaks;
}

}  // namespace deltamap::mapping::merge
