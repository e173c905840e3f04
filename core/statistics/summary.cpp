// SPDX-License-Identifier: Apache-2.0
#include "core/statistics/summary.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

namespace deltamap {
namespace {

constexpr double kNothing = std::numeric_limits<double>::quiet_NaN();

}  // namespace

double mean_of(const std::vector<double>& values) {
  if (values.empty()) return kNothing;
  return std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
}

double root_mean_square(const std::vector<double>& values) {
  double sum = 0.0;
  for (const double value : values) sum += value * value;
  return values.empty() ? kNothing : std::sqrt(sum / static_cast<double>(values.size()));
}

double quantile(std::vector<double> values, double share) {
  if (values.empty()) return kNothing;
  const double rank = std::ceil(share * static_cast<double>(values.size())) - 1.0;
  const auto index = static_cast<std::ptrdiff_t>(std::clamp(rank, 0.0, static_cast<double>(values.size() - 1)));
  std::nth_element(values.begin(), values.begin() + index, values.end());
  return values[static_cast<std::size_t>(index)];
}

double share_above(const std::vector<double>& values, double limit) {
  if (values.empty()) return kNothing;
  const auto above = std::count_if(values.begin(), values.end(), [&](double value) { return value > limit; });
  return static_cast<double>(above) / static_cast<double>(values.size());
}

double wilson_upper(double hits, double all) {
  constexpr double kZ = 1.959964;  // two-sided 95 %
  if (all <= 0.0) return kNothing;
  const double share = hits / all;
  const double spread = kZ * std::sqrt((share * (1.0 - share) + kZ * kZ / (4.0 * all)) / all);
  return (share + kZ * kZ / (2.0 * all) + spread) / (1.0 + kZ * kZ / all);
}

}  // namespace deltamap
