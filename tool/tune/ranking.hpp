// SPDX-License-Identifier: Apache-2.0
// What runs of several settings say of them: which is best by one measure, which are not shown to be worse, and
// whether these recordings can tell at all.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "core/statistics/paired_difference.hpp"
#include "tool/tune/measures.hpp"
#include "tool/tune/tuning_runs.hpp"

namespace deltamap::tool::tune {

/// A measure of each run: `[variant][drive][seed]`; NaN where there is none.
using MeasuredValues = std::vector<std::vector<std::vector<double>>>;
/// `runs` are the results of `wanted`. Seeds in the order of `seeds`; of other seeds nothing is taken.
[[nodiscard]] MeasuredValues values_of(const std::vector<WantedRun>& wanted, const std::vector<MeasuredRun>& runs,
                                       std::string_view measure, std::size_t variants, std::size_t drives,
                                       const std::vector<std::uint64_t>& seeds);

/// Mean over the drives of the means over their seeds; NaN where there are none.
[[nodiscard]] double mean_over_drives(const std::vector<std::vector<double>>& drives);

/// `second` less `first`, pair by pair.
[[nodiscard]] PairedDifference difference_of(const std::vector<std::vector<double>>& first,
                                             const std::vector<std::vector<double>>& second, double confidence = 0.95);

struct Ranked {
  double mean = 0.0;
  std::vector<double> of_drives{};  ///< means over the seeds
  PairedDifference from_best{};     ///< of the value itself, not of its cost; nothing of the best
  bool is_worse = false;            ///< shown to be
};

struct Ranking {
  std::vector<Ranked> variants;
  std::size_t best = 0;
  std::size_t first_not_worse = 0;  ///< in the order of the variants: the smallest setting of a range
  bool tells = false;               ///< some variant is shown to be worse than the best
  bool has_intervals = false;
};

/// The intervals are so much wider that all of them together hold with 95 % (Bonferroni). At least one variant with a
/// value that is no NaN, else throws std::runtime_error: the measure was not taken.
[[nodiscard]] Ranking ranking_of(const MeasuredValues& values, const Measure& measure);

/// "0.0012 m (0.0004 … 0.0021)", with a sign.
[[nodiscard]] std::string text_of(const PairedDifference& difference, const Measure& measure);
/// "B is better by …", "no difference that these recordings can show (…)", "too few runs to tell".
[[nodiscard]] std::string verdict_of(const PairedDifference& second_less_first, const Measure& measure,
                                     const std::string& first, const std::string& second);
/// What an interval speaks of: "of these recordings with other seeds".
[[nodiscard]] std::string scope_of(const PairedDifference& difference);

/// Four digits, as tables have them; "–" for NaN.
[[nodiscard]] std::string digits_of(double value);

}  // namespace deltamap::tool::tune
