// SPDX-License-Identifier: Apache-2.0
#include "tool/tune/halving.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <set>
#include <vector>

#include "core/random.hpp"

namespace deltamap::tool::tune {
namespace {

/// Distance from the optimum, and what a block adds: some of it to all settings, some to each by itself.
CostsOf noisy_bowl(const std::vector<double>& optimum, double noise, std::uint64_t seed) {
  return [=](const std::vector<Candidate>& drawn, const std::vector<Trial>& trials) {
    std::vector<double> costs;
    for (const Trial& trial : trials) {
      double square = 1.5;  // the settings as given are a bad place
      if (drawn[trial.candidate]) {
        square = 0.0;
        for (std::size_t p = 0; p < optimum.size(); ++p)
          square += std::pow((*drawn[trial.candidate])[p] - optimum[p], 2.0);
      }
      Random own{seed * 1000003 + trial.candidate * 1009 + trial.block};
      Random of_block{seed * 7919 + trial.block};
      costs.push_back(square + of_block.normal(5.0) + own.normal(noise));
    }
    return costs;
  };
}

double distance_of_winner(const Searched& found, const std::vector<double>& optimum) {
  if (!found.drawn[found.winner]) return 1e9;
  double square = 0.0;
  for (std::size_t p = 0; p < optimum.size(); ++p)
    square += std::pow((*found.drawn[found.winner])[p] - optimum[p], 2.0);
  return std::sqrt(square);
}

TEST(Halving, ComesNearAnOptimumOfFourKeysWithin150Runs) {
  const std::vector<double> optimum{0.2, 0.8, 0.5, 0.35};
  int near = 0;
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    const Searched found = searched_by_halving({4, 150, 64, seed}, noisy_bowl(optimum, 0.02, seed));
    EXPECT_LE(found.runs, 150u);
    near += distance_of_winner(found, optimum) < 0.35 ? 1 : 0;
  }
  EXPECT_GE(near, 18) << "a random setting lies so near in one case of forty";
}

TEST(Halving, DropsMostSettingsEarlyAndTriesAllOnTheSameBlocks) {
  std::set<Trial> seen;
  const CostsOf bowl = noisy_bowl({0.3}, 0.01, 3);
  const Searched found = searched_by_halving({1, 90, 64, 3}, [&](const auto& drawn, const auto& trials) {
    for (const Trial& trial : trials) EXPECT_TRUE(seen.insert(trial).second) << "no run is done twice";
    return bowl(drawn, trials);
  });
  const auto once =
      std::count_if(found.costs.begin(), found.costs.end(), [](const auto& of) { return of.size() == 1; });
  EXPECT_GE(2 * once + 2, static_cast<std::ptrdiff_t>(found.costs.size())) << "half of them are seen once";
  std::size_t most = 0;
  for (const auto& of : found.costs) most = std::max(most, of.size());
  EXPECT_EQ(found.costs[found.winner].size(), most);
}

TEST(Halving, IsTheSameWithTheSameSeedAndKeepsWithinItsBudget) {
  for (const std::size_t budget : {kLeastBudget, std::size_t{20}, std::size_t{61}, std::size_t{500}}) {
    const CostsOf bowl = noisy_bowl({0.5, 0.5}, 0.1, budget);
    const Searched a = searched_by_halving({2, budget, 8, 9}, bowl);
    const Searched b = searched_by_halving({2, budget, 8, 9}, bowl);
    EXPECT_EQ(a.drawn, b.drawn);
    EXPECT_EQ(a.winner, b.winner);
    EXPECT_LE(a.runs, budget);
    EXPECT_GE(2 * a.runs, budget) << "and makes use of it";
  }
}

TEST(Halving, NeverChoosesWhatCannotBeRun) {
  const Searched found = searched_by_halving({1, 40, 8, 1}, [](const auto& drawn, const std::vector<Trial>& trials) {
    std::vector<double> costs;
    for (const Trial& trial : trials) costs.push_back(drawn[trial.candidate] ? std::nan("") : 1.0);
    return costs;
  });
  EXPECT_EQ(found.winner, 0u) << "the settings as given";
}

}  // namespace
}  // namespace deltamap::tool::tune
