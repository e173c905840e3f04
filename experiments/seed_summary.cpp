// SPDX-License-Identifier: Apache-2.0
#include "experiments/seed_summary.hpp"

#include <algorithm>
#include <cmath>

namespace deltamap::experiments {
namespace {

std::optional<Target> target_of(const std::optional<double>& limit, Better better) {
  if (!limit) return std::nullopt;
  return better == Better::kLess ? Target{.most = limit} : Target{.least = limit};
}

}  // namespace

Spread spread_of(const std::vector<double>& values, Better better) {
  const double sign = better == Better::kLess ? 1.0 : -1.0;
  std::vector<double> costs;
  for (const double value : values) {
    if (!std::isnan(value)) costs.push_back(sign * value);
  }
  return {sign * quantile(costs, 0.5), sign * quantile(costs, 0.9), sign * quantile(costs, 1.0)};
}

std::vector<Figure> spread_figures(const std::vector<SpreadAsked>& asked, const std::vector<Outcome>& outcomes) {
  std::vector<Figure> figures;
  for (const SpreadAsked& one : asked) {
    std::vector<double> values;
    values.reserve(outcomes.size());
    for (const Outcome& outcome : outcomes) values.push_back(outcome.number(one.number));
    if (std::all_of(values.begin(), values.end(), [](double value) { return std::isnan(value); })) continue;
    const Spread spread = spread_of(values, one.better);
    const double nine_of_ten = one.better == Better::kLess ? 0.9 : 0.1;
    figures.push_back({one.number + ", median", spread.median, one.unit, target_of(one.median, one.better), "",
                       certainty_of_quantile(values, 0.5)});
    figures.push_back({one.number + ", nine of ten", spread.nine_of_ten, one.unit,
                       target_of(one.nine_of_ten, one.better), "", certainty_of_quantile(values, nine_of_ten)});
    figures.push_back({one.number + ", worst", spread.worst, one.unit, target_of(one.worst, one.better), "",
                       certainty_of_extreme(values)});
  }
  return figures;
}

Figure count_of_seeds(const std::string& name, const std::vector<Outcome>& outcomes,
                      const std::function<bool(const Outcome&)>& holds, const std::optional<Target>& target) {
  const auto found = std::count_if(outcomes.begin(), outcomes.end(), holds);
  return {name, static_cast<double>(found), "", target, "", Certainty{.runs = outcomes.size()}};
}

Chart chart_in_order(const std::string& what, const std::string& number, const std::vector<Outcome>& outcomes) {
  std::vector<double> values;
  values.reserve(outcomes.size());
  for (const Outcome& outcome : outcomes) values.push_back(outcome.number(number));
  std::erase_if(values, [](double value) { return std::isnan(value); });
  std::sort(values.begin(), values.end());
  Series series{number, {}};
  for (std::size_t i = 0; i < values.size(); ++i)
    series.points.emplace_back(static_cast<double>(i + 1) / static_cast<double>(values.size()), values[i]);
  return {what + ", seeds in order", "share of the seeds", what, {series}};
}

}  // namespace deltamap::experiments
