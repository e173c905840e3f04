// SPDX-License-Identifier: Apache-2.0
// What a figure is over many seeds: its median, what nine of ten reach, and the worst; or a sum, a ratio, a mean and
// the most of all runs together.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "experiments/experiment.hpp"

namespace deltamap::experiments {

enum class Better : std::uint8_t { kLess, kMore };

/// NaN where there are no values.
struct Spread {
  double median = 0.0;
  double nine_of_ten = 0.0;  ///< nine of ten seeds are as good or better
  double worst = 0.0;
};
/// Values that are NaN say nothing and are left out.
[[nodiscard]] Spread spread_of(const std::vector<double>& values, Better better);

/// A number of every run, and what is asked of its median, of nine of ten, and of the worst.
struct SpreadAsked {
  std::string number;
  std::string unit{};
  Better better = Better::kLess;
  std::optional<double> median{};
  std::optional<double> nine_of_ten{};
  std::optional<double> worst{};
};

/// Three figures of each number.
[[nodiscard]] std::vector<Figure> spread_figures(const std::vector<SpreadAsked>& asked,
                                                 const std::vector<Outcome>& outcomes);

/// In how many runs something holds.
[[nodiscard]] Figure count_of_seeds(const std::string& name, const std::vector<Outcome>& outcomes,
                                    const std::function<bool(const Outcome&)>& holds,
                                    const std::optional<Target>& target = {});

/// One number to another: how often of how often, so much an hour.
struct Ratio {
  std::string_view part;  ///< names of numbers, literals
  std::string_view whole;
  double scale = 1.0;
};

/// Figures of all runs together, each with their number. A sum and the most have no interval.
[[nodiscard]] Figure sum_of_runs(const std::string& name, const std::vector<const Outcome*>& runs,
                                 const std::string& number, const std::optional<Target>& target = {},
                                 const std::string& unit = "");
/// Of the sums over the runs, not the mean of their ratios; NaN where the whole is 0.
[[nodiscard]] Figure ratio_of_runs(const std::string& name, const std::vector<const Outcome*>& runs, const Ratio& ratio,
                                   const std::optional<Target>& target = {}, const std::string& unit = "");
[[nodiscard]] Figure mean_of_runs(const std::string& name, const std::vector<const Outcome*>& runs,
                                  const std::string& number, const std::optional<Target>& target = {},
                                  const std::string& unit = "");
[[nodiscard]] Figure most_of_runs(const std::string& name, const std::vector<const Outcome*>& runs,
                                  const std::string& number, const std::optional<Target>& target = {},
                                  const std::string& unit = "");

/// Each ratio of all runs in order of size, under its name; runs whose whole is 0 are left out.
[[nodiscard]] Chart ratios_in_order(const std::string& what, const std::vector<std::pair<std::string, Ratio>>& ratios,
                                    const std::vector<const Outcome*>& runs);
/// The values of all runs in order of size: how long the tail is.
[[nodiscard]] Chart chart_in_order(const std::string& what, const std::string& number,
                                   const std::vector<Outcome>& outcomes);

}  // namespace deltamap::experiments
