// SPDX-License-Identifier: Apache-2.0
// Searches several parameters at once within a budget of runs, by successive halving (Jamieson and Talwalkar 2016):
// many settings are tried on one block (a recording with a seed), the better half on a second, half of those on two
// more, and so on, always on the same blocks, so that most settings are dropped early. The next round draws around the
// winner of the last, in a box of half the width.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <vector>

namespace deltamap::tool::tune {

/// Where in the range of each parameter, 0 to 1; nothing: the settings as given.
using Candidate = std::optional<std::vector<double>>;

struct Trial {
  std::size_t candidate = 0;  ///< of those that the search has drawn so far
  std::size_t block = 0;
  friend auto operator<=>(const Trial&, const Trial&) = default;
};

/// Runs all of these, and answers the cost of each: less is better, NaN is worst.
using CostsOf = std::function<std::vector<double>(const std::vector<Candidate>& drawn, const std::vector<Trial>&)>;

struct HalvingParams {
  std::size_t parameters = 1;  ///< > 0
  std::size_t budget = 100;    ///< runs; at least kLeastBudget
  std::size_t blocks = 64;     ///< that there are at most; > 0
  std::uint64_t seed = 1;
};
inline constexpr std::size_t kLeastBudget = 6;

struct Searched {
  std::vector<Candidate> drawn;            ///< the first is the settings as given
  std::vector<std::vector<double>> costs;  ///< of each, on the first so many blocks
  std::size_t winner = 0;
  std::size_t runs = 0;  ///< that were needed; at most the budget
};
[[nodiscard]] Searched searched_by_halving(const HalvingParams& params, const CostsOf& costs_of);

}  // namespace deltamap::tool::tune
