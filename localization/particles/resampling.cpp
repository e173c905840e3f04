// SPDX-License-Identifier: Apache-2.0
// Why not draw at every scan: each drawing loses particles by chance, and a robot that stands would be left with
// copies of a few. Low variance needs one random number for all draws, and of equal weights it loses none.
#include "localization/particles/resampling.hpp"

#include <cassert>
#include <cmath>

namespace deltamap::localization::particles {

double effective_sample_size(std::span<const double> weights) {
  double sum = 0.0;
  double sum_of_squares = 0.0;
  for (const double weight : weights) {
    sum += weight;
    sum_of_squares += weight * weight;
  }
  return sum_of_squares > 0.0 ? sum * sum / sum_of_squares : 0.0;
}

std::vector<std::uint32_t> low_variance_choice(std::span<const double> weights, std::size_t count, double offset,
                                               std::vector<std::uint32_t> choice) {
  assert(!weights.empty() && "there must be something to choose from");
  choice.clear();
  choice.reserve(count);
  const double tooth = 1.0 / static_cast<double>(count);
  std::size_t chosen = 0;
  double reached = weights[0];
  for (std::size_t i = 0; i < count; ++i) {
    const double wanted = (static_cast<double>(i) + offset) * tooth;
    while (reached < wanted && chosen + 1 < weights.size()) reached += weights[++chosen];
    choice.push_back(static_cast<std::uint32_t>(chosen));
  }
  return choice;
}

std::size_t kld_sample_count(std::size_t bins, double error, double z) {
  if (bins < 2) return 1;
  const double free_bins = static_cast<double>(bins - 1);
  const double a = 2.0 / (9.0 * free_bins);
  const double b = 1.0 - a + std::sqrt(a) * z;
  return static_cast<std::size_t>(std::ceil(free_bins / (2.0 * error) * b * b * b));
}

}  // namespace deltamap::localization::particles
