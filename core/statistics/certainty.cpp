// SPDX-License-Identifier: Apache-2.0
#include "core/statistics/certainty.hpp"

#include <algorithm>
#include <cmath>
#include <map>

#include "core/random.hpp"
#include "core/statistics/summary.hpp"

namespace deltamap {
namespace {

constexpr std::size_t kLeastRuns = 5;
constexpr int kResamples = 1000;
constexpr std::uint64_t kSeed = 1979;
constexpr double kOutside = 0.025;  // on either side

std::vector<double> known(std::vector<double> values) {
  std::erase_if(values, [](double value) { return std::isnan(value); });
  return values;
}

/// The figures of each resample. Few runs are drawn alike again and again: then what is known is taken.
std::vector<std::vector<double>> resampled(std::size_t runs, const FiguresOfRuns& figures_of) {
  Random random{kSeed};
  std::map<std::vector<std::size_t>, std::vector<double>> known_of;
  std::vector<std::vector<double>> answers;
  std::vector<std::size_t> drawn(runs);
  for (int i = 0; i < kResamples; ++i) {
    for (std::size_t& run : drawn) run = random.index_below(static_cast<std::uint32_t>(runs));
    std::sort(drawn.begin(), drawn.end());
    auto found = known_of.find(drawn);
    if (found == known_of.end()) found = known_of.emplace(drawn, figures_of(drawn)).first;
    answers.push_back(found->second);
  }
  return answers;
}

}  // namespace

std::vector<Certainty> certainties_of_runs(std::size_t runs, const FiguresOfRuns& figures_of) {
  std::vector<std::size_t> each(runs);
  for (std::size_t i = 0; i < runs; ++i) each[i] = i;
  std::vector<Certainty> certainties(figures_of(each).size(), Certainty{.runs = runs});
  if (runs < kLeastRuns) return certainties;
  const std::vector<std::vector<double>> answers = resampled(runs, figures_of);
  for (std::size_t figure = 0; figure < certainties.size(); ++figure) {
    std::vector<double> values;
    values.reserve(answers.size());
    for (const std::vector<double>& answer : answers) values.push_back(answer[figure]);
    values = known(std::move(values));
    certainties[figure].low = quantile(values, kOutside);
    certainties[figure].high = quantile(values, 1.0 - kOutside);
  }
  return certainties;
}

namespace {

/// Each value is a run of its own.
template <typename Statistic>
Certainty by_bootstrap(const std::vector<double>& given, Statistic&& statistic) {
  const std::vector<double> values = known(given);
  const auto statistic_of = [&](const std::vector<std::size_t>& drawn) -> std::vector<double> {
    std::vector<double> of;
    of.reserve(drawn.size());
    for (const std::size_t run : drawn) of.push_back(values[run]);
    return {statistic(of)};
  };
  return certainties_of_runs(values.size(), statistic_of).front();
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

}  // namespace deltamap
