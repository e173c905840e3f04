// SPDX-License-Identifier: Apache-2.0
// How sure a figure is that is made of many runs: their number, and an interval that other runs of the kind would move
// it in.
#pragma once

#include <cstddef>
#include <functional>
#include <limits>
#include <vector>

namespace deltamap {

struct Certainty {
  std::size_t runs = 0;
  double low = std::numeric_limits<double>::quiet_NaN();  ///< of the 95 % interval; NaN where there is none
  double high = std::numeric_limits<double>::quiet_NaN();
  [[nodiscard]] bool has_interval() const { return low <= high; }
};

/// Of a mean, of a quantile, of a root mean square: by bootstrap (Efron 1979), percentiles of 1000 resamples from a
/// fixed seed. Values that are NaN are left out; fewer than five runs have no interval.
[[nodiscard]] Certainty certainty_of_mean(const std::vector<double>& values);
[[nodiscard]] Certainty certainty_of_quantile(const std::vector<double>& values, double share);
[[nodiscard]] Certainty certainty_of_root_mean_square(const std::vector<double>& values);
/// Of a figure that is made of whole runs in any other way (scans of all runs together, shares of runs): `figures_of`
/// answers the figures that the named runs would give, one run named as often as it was drawn, in order; a certainty
/// for each comes back. Resamples whose figure is NaN say nothing.
using FiguresOfRuns = std::function<std::vector<double>(const std::vector<std::size_t>& drawn)>;
[[nodiscard]] std::vector<Certainty> certainties_of_runs(std::size_t runs, const FiguresOfRuns& figures_of);
/// Of the least or the most of all, and of a count: resampling says nothing of what lies beyond.
[[nodiscard]] Certainty certainty_of_extreme(const std::vector<double>& values);

}  // namespace deltamap
