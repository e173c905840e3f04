// SPDX-License-Identifier: Apache-2.0
#include "experiments/certainty.hpp"

#include <algorithm>
#include <cmath>

#include "core/random.hpp"
#include "experiments/scan_table.hpp"

namespace deltamap::experiments {
namespace {

constexpr std::size_t kLeastRuns = 5;
constexpr int kResamples = 1000;
constexpr std::uint64_t kSeed = 1979;
constexpr double kOutside = 0.025;  // on either side

std::vector<double> known(std::vector<double> values) {
  std::erase_if(values, [](double value) { return std::isnan(value); });
  return values;
}

template <typename Statistic>
Certainty by_bootstrap(const std::vector<double>& given, Statistic&& statistic) {
  const std::vector<double> values = known(given);
  Certainty certainty{.runs = values.size()};
  if (values.size() < kLeastRuns) return certainty;
  Random random{kSeed};
  std::vector<double> answers;
  std::vector<double> drawn(values.size());
  for (int i = 0; i < kResamples; ++i) {
    for (double& value : drawn) value = values[random.index_below(static_cast<std::uint32_t>(values.size()))];
    answers.push_back(statistic(drawn));
  }
  certainty.low = quantile(answers, kOutside);
  certainty.high = quantile(answers, 1.0 - kOutside);
  return certainty;
}

}  // namespace

Certainty certainty_of_mean(const std::vector<double>& values) { return by_bootstrap(values, mean_of); }

Certainty certainty_of_quantile(const std::vector<double>& values, double share) {
  return by_bootstrap(values, [share](const std::vector<double>& drawn) { return quantile(drawn, share); });
}

Certainty certainty_of_root_mean_square(const std::vector<double>& values) {
  return by_bootstrap(values, root_mean_square);
}

Certainty certainty_of_extreme(const std::vector<double>& values) { return {.runs = known(values).size()}; }

}  // namespace deltamap::experiments
