// SPDX-License-Identifier: Apache-2.0
// The best local maxima of a sampled signal.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

namespace deltamap::mapping::merge {

struct SpectrumPeak {
  std::size_t index = 0;
  double offset = 0.0;  ///< of the parabola through the peak and its neighbours, from the index; [-0.5, 0.5]
  double value = 0.0;
};

enum class SpectrumEnds : char {
  kOpen,   ///< nothing beyond the first and last sample
  kJoined  ///< circular
};

/// At most n maxima, best first. A maximum is the largest of the samples within `apart` on either side; of equal ones
/// the first counts.
[[nodiscard]] std::vector<SpectrumPeak> best_peaks(std::span<const double> signal, int n, int apart, SpectrumEnds ends);

}  // namespace deltamap::mapping::merge
