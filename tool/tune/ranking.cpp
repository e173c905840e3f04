// SPDX-License-Identifier: Apache-2.0
#include "tool/tune/ranking.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>
#include <stdexcept>

#include "core/statistics/summary.hpp"

namespace deltamap::tool::tune {
namespace {

constexpr double kError = 0.05;  // of all intervals of one ranking together
constexpr double kUnknown = std::numeric_limits<double>::quiet_NaN();

std::vector<double> known_among(std::vector<double> values) {
  std::erase_if(values, [](double value) { return std::isnan(value); });
  return values;
}

std::vector<double> means_of(const std::vector<std::vector<double>>& drives) {
  std::vector<double> means;
  for (const std::vector<double>& values : drives) means.push_back(mean_of(known_among(values)));
  return means;
}

std::string with_sign(double value) { return (value > 0.0 ? "+" : "") + digits_of(value); }

std::string unit_behind(const Measure& measure) { return measure.unit.empty() ? "" : " " + std::string{measure.unit}; }

}  // namespace

MeasuredValues values_of(const std::vector<WantedRun>& wanted, const std::vector<MeasuredRun>& runs,
                         std::string_view measure, std::size_t variants, std::size_t drives,
                         const std::vector<std::uint64_t>& seeds) {
  const std::vector<double> no_seeds(seeds.size(), kUnknown);
  MeasuredValues values(variants, std::vector<std::vector<double>>(drives, no_seeds));
  for (std::size_t i = 0; i < wanted.size(); ++i) {
    const auto seed = std::find(seeds.begin(), seeds.end(), wanted[i].seed);
    if (seed == seeds.end()) continue;
    values[wanted[i].variant][wanted[i].drive][static_cast<std::size_t>(seed - seeds.begin())] =
        number_of(runs[i].numbers, measure);
  }
  return values;
}

double mean_over_drives(const std::vector<std::vector<double>>& drives) {
  return mean_of(known_among(means_of(drives)));
}

PairedDifference difference_of(const std::vector<std::vector<double>>& first,
                               const std::vector<std::vector<double>>& second, double confidence) {
  std::vector<std::vector<double>> differences(first.size());
  for (std::size_t drive = 0; drive < first.size(); ++drive) {
    for (std::size_t seed = 0; seed < first[drive].size(); ++seed) {
      differences[drive].push_back(second[drive][seed] - first[drive][seed]);
    }
  }
  return paired_difference(differences, confidence);
}

Ranking ranking_of(const MeasuredValues& values, const Measure& measure) {
  Ranking ranking;
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < values.size(); ++i) {
    ranking.variants.push_back({mean_over_drives(values[i]), means_of(values[i])});
    const double cost = measure.cost(ranking.variants.back().mean);
    if (std::isnan(cost) || cost >= least) continue;
    least = cost;
    ranking.best = i;
  }
  if (std::isinf(least)) throw std::runtime_error("'" + std::string{measure.name} + "' was measured in no run");
  const double others = static_cast<double>(std::max<std::size_t>(1, values.size() - 1));
  for (std::size_t i = 0; i < values.size(); ++i) {
    if (i == ranking.best) continue;
    Ranked& one = ranking.variants[i];
    one.from_best = difference_of(values[ranking.best], values[i], 1.0 - kError / others);
    one.is_worse = one.from_best.is_shown() && measure.cost(one.from_best.mean) > 0.0;
    ranking.tells = ranking.tells || one.is_worse;
    ranking.has_intervals = ranking.has_intervals || one.from_best.has_interval();
  }
  const auto first = std::find_if(ranking.variants.begin(), ranking.variants.end(),
                                  [](const Ranked& one) { return !one.is_worse && !std::isnan(one.mean); });
  ranking.first_not_worse = static_cast<std::size_t>(first - ranking.variants.begin());
  if (!ranking.has_intervals) ranking.first_not_worse = ranking.best;
  return ranking;
}

std::string digits_of(double value) {
  if (std::isnan(value)) return "–";
  char text[32];
  (void)std::snprintf(text, sizeof text, "%.4g", value);
  return text;
}

std::string text_of(const PairedDifference& difference, const Measure& measure) {
  if (std::isnan(difference.mean)) return "–";
  std::string text = with_sign(difference.mean) + unit_behind(measure);
  if (difference.has_interval()) text += " (" + with_sign(difference.low) + " … " + with_sign(difference.high) + ")";
  return text;
}

std::string verdict_of(const PairedDifference& second_less_first, const Measure& measure, const std::string& first,
                       const std::string& second) {
  const std::string interval = text_of(second_less_first, measure);
  if (!second_less_first.has_interval()) return "too few runs to tell: give more seeds";
  if (!second_less_first.is_shown()) return "no difference that these recordings can show";
  if (measure.better == Better::kNeither) return second + ": " + interval;
  const bool second_wins = measure.cost(second_less_first.mean) < 0.0;
  return (second_wins ? second : first) + " is better";
}

std::string scope_of(const PairedDifference& difference) {
  const std::string pairs = std::to_string(difference.pairs) + (difference.pairs == 1 ? " pair of " : " pairs of ") +
                            std::to_string(difference.recordings) +
                            (difference.recordings == 1 ? " recording" : " recordings");
  if (difference.of == PairedDifference::Of::kRecordings) return pairs + "; intervals are of recordings of their kind";
  if (difference.of == PairedDifference::Of::kSeeds)
    return pairs + "; intervals are of these recordings with other seeds";
  return pairs + "; too few for intervals";
}

}  // namespace deltamap::tool::tune
