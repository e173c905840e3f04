// SPDX-License-Identifier: Apache-2.0
#include "tool/tune/halving.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "core/random.hpp"
#include "core/statistics/summary.hpp"

namespace deltamap::tool::tune {
namespace {

constexpr std::size_t kRounds = 3;
constexpr std::size_t kBudgetOfARound = 20;  // with less, rounds are left out

class Halving {
 public:
  Halving(const HalvingParams& params, const CostsOf& costs_of)
      : params_{params}, costs_of_{costs_of}, random_{params.seed} {
    (void)draw(std::nullopt);
  }

  /// `alive`: of those drawn, to be halved on more and more blocks until one is left or the budget is spent.
  void halve(std::vector<std::size_t> alive, std::size_t budget) {
    const std::size_t last_run = found_.runs + budget;
    for (std::size_t blocks = 1;; blocks = std::min(2 * blocks, params_.blocks)) {
      if (found_.runs + missing_of(alive, blocks).size() > last_run) break;
      run(missing_of(alive, blocks));
      std::stable_sort(alive.begin(), alive.end(),
                       [&](std::size_t a, std::size_t b) { return cost(a, blocks) < cost(b, blocks); });
      found_.winner = alive.front();
      if (alive.size() == 1 || blocks == params_.blocks) break;
      alive.resize((alive.size() + 1) / 2);
    }
  }

  /// One in each of so many slices of each parameter's range, which is cut to a box around the winner.
  std::vector<std::size_t> draw_around_winner(std::size_t count, double width) {
    std::vector<std::vector<double>> points(count, std::vector<double>(params_.parameters));
    const Candidate& winner = found_.drawn[found_.winner];
    for (std::size_t p = 0; p < params_.parameters; ++p) {
      const double middle = winner ? (*winner)[p] : 0.5;
      const double reach = winner ? width : 1.0;
      const double low = std::clamp(middle - 0.5 * reach, 0.0, 1.0 - reach);
      std::vector<std::size_t> slices(count);
      std::iota(slices.begin(), slices.end(), std::size_t{0});
      for (std::size_t i = count; i > 1; --i)
        std::swap(slices[i - 1], slices[random_.index_below(static_cast<std::uint32_t>(i))]);
      for (std::size_t i = 0; i < count; ++i) {
        const double share = (static_cast<double>(slices[i]) + random_.uniform()) / static_cast<double>(count);
        points[i][p] = low + reach * share;
      }
    }
    std::vector<std::size_t> drawn;
    for (auto& point : points) drawn.push_back(draw(std::move(point)));
    return drawn;
  }

  [[nodiscard]] std::size_t winner() const { return found_.winner; }
  [[nodiscard]] Searched found() && { return std::move(found_); }
  [[nodiscard]] std::size_t runs() const { return found_.runs; }

 private:
  std::size_t draw(Candidate candidate) {
    found_.drawn.push_back(std::move(candidate));
    found_.costs.emplace_back();
    return found_.drawn.size() - 1;
  }

  /// Blocks are done in order, so that what is missing is what lies behind.
  [[nodiscard]] std::vector<Trial> missing_of(const std::vector<std::size_t>& alive, std::size_t blocks) const {
    std::vector<Trial> missing;
    for (const std::size_t candidate : alive) {
      for (std::size_t block = found_.costs[candidate].size(); block < blocks; ++block)
        missing.push_back({candidate, block});
    }
    return missing;
  }

  void run(const std::vector<Trial>& trials) {
    if (trials.empty()) return;
    const std::vector<double> costs = costs_of_(found_.drawn, trials);
    for (std::size_t i = 0; i < trials.size(); ++i) {
      const double known = std::isnan(costs[i]) ? std::numeric_limits<double>::infinity() : costs[i];
      found_.costs[trials[i].candidate].push_back(known);
    }
    found_.runs += trials.size();
  }

  [[nodiscard]] double cost(std::size_t candidate, std::size_t blocks) const {
    const std::vector<double>& all = found_.costs[candidate];
    return mean_of({all.begin(), all.begin() + static_cast<std::ptrdiff_t>(std::min(blocks, all.size()))});
  }

  HalvingParams params_;
  const CostsOf& costs_of_;
  Random random_;
  Searched found_;
};

/// Settings that a round can begin with: each half costs as many runs again as the one before, until three are left.
std::size_t beginners_of(std::size_t budget) {
  const auto runs_of = [](std::size_t alive) {
    std::size_t runs = alive;
    for (std::size_t blocks = 1; alive > 2; blocks *= 2) {
      alive = (alive + 1) / 2;
      runs += alive * blocks;
    }
    return runs;
  };
  std::size_t beginners = 2;
  while (runs_of(beginners + 1) <= budget) ++beginners;
  return beginners;
}

}  // namespace

Searched searched_by_halving(const HalvingParams& params, const CostsOf& costs_of) {
  Halving halving{params, costs_of};
  const std::size_t rounds = std::clamp<std::size_t>(params.budget / kBudgetOfARound, 1, kRounds);
  double width = 1.0;
  // What a round leaves over, since the next halving would have cost more, is spent on more rounds of the same kind.
  for (std::size_t round = 0; round < 2 * rounds && params.budget >= halving.runs() + kLeastBudget; ++round) {
    const std::size_t budget = (params.budget - halving.runs()) / (round < rounds ? rounds - round : 1);
    const std::size_t beginners = beginners_of(budget);
    std::vector<std::size_t> alive{halving.winner()};
    for (const std::size_t drawn : halving.draw_around_winner(beginners - 1, width)) alive.push_back(drawn);
    halving.halve(std::move(alive), budget);
    if (round + 1 < rounds) width *= 0.5;
  }
  return std::move(halving).found();
}

}  // namespace deltamap::tool::tune
