// SPDX-License-Identifier: Apache-2.0
#include "experiments/seed_summary.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "core/statistics/summary.hpp"
#include "experiments/pooled_runs.hpp"

namespace deltamap::experiments {
namespace {

std::optional<Target> target_of(const std::optional<double>& limit, Better better) {
  if (!limit) return std::nullopt;
  return better == Better::kLess ? Target{.most = limit} : Target{.least = limit};
}

std::vector<double> values_of(const std::vector<const Outcome*>& runs, std::string_view number) {
  std::vector<double> values;
  values.reserve(runs.size());
  for (const Outcome* run : runs) values.push_back(run->number(number));
  return values;
}

double sum_of(const std::vector<double>& values) { return std::accumulate(values.begin(), values.end(), 0.0); }

double ratio_of(const std::vector<const Outcome*>& runs, const Ratio& ratio) {
  const double whole = sum_of(values_of(runs, ratio.whole));
  return whole > 0.0 ? ratio.scale * sum_of(values_of(runs, ratio.part)) / whole
                     : std::numeric_limits<double>::quiet_NaN();
}

Series in_order(const std::string& name, std::vector<double> values) {
  std::erase_if(values, [](double value) { return std::isnan(value); });
  std::sort(values.begin(), values.end());
  Series series{name, {}};
  for (std::size_t i = 0; i < values.size(); ++i)
    series.points.emplace_back(static_cast<double>(i + 1) / static_cast<double>(values.size()), values[i]);
  return series;
}

Chart chart_of(const std::string& what, std::vector<Series> series) {
  return {what + ", runs in order", "share of the runs", what, std::move(series)};
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

Figure sum_of_runs(const std::string& name, const std::vector<const Outcome*>& runs, const std::string& number,
                   const std::optional<Target>& target, const std::string& unit) {
  return {name, sum_of(values_of(runs, number)), unit, target, "", Certainty{.runs = runs.size()}};
}

Figure ratio_of_runs(const std::string& name, const std::vector<const Outcome*>& runs, const Ratio& ratio,
                     const std::optional<Target>& target, const std::string& unit) {
  const auto of_drawn = [&](const std::vector<std::size_t>& drawn) {
    std::vector<const Outcome*> chosen;
    chosen.reserve(drawn.size());
    for (const std::size_t run : drawn) chosen.push_back(runs[run]);
    return std::vector<double>{ratio_of(chosen, ratio)};
  };
  return {name, ratio_of(runs, ratio), unit, target, "", certainties_of_runs(runs.size(), of_drawn).front()};
}

Figure mean_of_runs(const std::string& name, const std::vector<const Outcome*>& runs, const std::string& number,
                    const std::optional<Target>& target, const std::string& unit) {
  const std::vector<double> values = values_of(runs, number);
  return {name, mean_of(values), unit, target, "", certainty_of_mean(values)};
}

Figure most_of_runs(const std::string& name, const std::vector<const Outcome*>& runs, const std::string& number,
                    const std::optional<Target>& target, const std::string& unit) {
  const std::vector<double> values = values_of(runs, number);
  return {name, quantile(values, 1.0), unit, target, "", certainty_of_extreme(values)};
}

Chart ratios_in_order(const std::string& what, const std::vector<std::pair<std::string, Ratio>>& ratios,
                      const std::vector<const Outcome*>& runs) {
  std::vector<Series> series;
  for (const auto& [name, ratio] : ratios) {
    std::vector<double> values;
    values.reserve(runs.size());
    for (const Outcome* run : runs) values.push_back(ratio_of({run}, ratio));
    series.push_back(in_order(name, std::move(values)));
  }
  return chart_of(what, std::move(series));
}

Chart chart_in_order(const std::string& what, const std::string& number, const std::vector<Outcome>& outcomes) {
  return chart_of(what, {in_order(number, values_of(runs_with(outcomes, {}), number))});
}

}  // namespace deltamap::experiments
