// SPDX-License-Identifier: Apache-2.0
#include "core/statistics/paired_difference.hpp"

#include <algorithm>
#include <cmath>

#include "core/statistics/summary.hpp"

namespace deltamap {
namespace {

constexpr std::size_t kLeastRecordings = 5;  // to speak of others of their kind

double variance_of(const std::vector<double>& values) {
  const double mean = mean_of(values);
  double sum = 0.0;
  for (const double value : values) sum += (value - mean) * (value - mean);
  return sum / static_cast<double>(values.size() - 1);
}

std::vector<std::vector<double>> known_of(const std::vector<std::vector<double>>& given) {
  std::vector<std::vector<double>> known;
  for (std::vector<double> values : given) {
    std::erase_if(values, [](double value) { return !std::isfinite(value); });
    if (!values.empty()) known.push_back(std::move(values));
  }
  return known;
}

/// Of a mean: its variance and what that was estimated from.
struct Scatter {
  double variance = 0.0;
  double freedom = 1.0;
};

Scatter scatter_of_seeds(const std::vector<std::vector<double>>& recordings) {
  const double count = static_cast<double>(recordings.size());
  Scatter scatter;
  double squares = 0.0;
  for (const std::vector<double>& values : recordings) {
    const double n = static_cast<double>(values.size());
    const double part = variance_of(values) / n / (count * count);
    scatter.variance += part;
    squares += part * part / (n - 1.0);
  }
  if (squares > 0.0) scatter.freedom = scatter.variance * scatter.variance / squares;
  return scatter;
}

/// The continued fraction of the incomplete beta function (Abramowitz and Stegun 26.5.8), by Lentz's method.
double beta_fraction(double a, double b, double x) {
  constexpr double kTiny = 1e-300;
  constexpr int kMostTerms = 500;
  const auto kept = [](double value) { return std::abs(value) < kTiny ? kTiny : value; };
  double c = 1.0;
  double d = 1.0 / kept(1.0 - (a + b) * x / (a + 1.0));
  double fraction = d;
  for (int m = 1; m <= kMostTerms; ++m) {
    const double two_m = 2.0 * m;
    const double even = m * (b - m) * x / ((a + two_m - 1.0) * (a + two_m));
    const double odd = -(a + m) * (a + b + m) * x / ((a + two_m) * (a + two_m + 1.0));
    double step = 1.0;
    for (const double term : {even, odd}) {
      d = 1.0 / kept(1.0 + term * d);
      c = kept(1.0 + term / c);
      step = d * c;
      fraction *= step;
    }
    if (std::abs(step - 1.0) < 1e-14) break;
  }
  return fraction;
}

double incomplete_beta(double a, double b, double x) {
  if (x <= 0.0 || x >= 1.0) return x <= 0.0 ? 0.0 : 1.0;
  const double front =
      std::exp(std::lgamma(a + b) - std::lgamma(a) - std::lgamma(b) + a * std::log(x) + b * std::log1p(-x));
  const bool converges = x < (a + 1.0) / (a + b + 2.0);
  return converges ? front * beta_fraction(a, b, x) / a : 1.0 - front * beta_fraction(b, a, 1.0 - x) / b;
}

}  // namespace

double student_quantile(double probability, double freedom) {
  if (probability < 0.5) return -student_quantile(1.0 - probability, freedom);
  const auto is_below = [&](double t) {
    return 1.0 - 0.5 * incomplete_beta(0.5 * freedom, 0.5, freedom / (freedom + t * t)) < probability;
  };
  double low = 0.0;
  double high = 1.0;
  while (is_below(high) && high < 1e12) high *= 2.0;
  for (int i = 0; i < 100; ++i) {
    const double middle = 0.5 * (low + high);
    (is_below(middle) ? low : high) = middle;
  }
  return 0.5 * (low + high);
}

PairedDifference paired_difference(const std::vector<std::vector<double>>& differences, double confidence) {
  const std::vector<std::vector<double>> recordings = known_of(differences);
  PairedDifference answer;
  answer.recordings = recordings.size();
  std::vector<double> means;
  for (const std::vector<double>& values : recordings) {
    answer.pairs += values.size();
    means.push_back(mean_of(values));
  }
  answer.mean = mean_of(means);
  const bool has_seeds = !recordings.empty() && std::all_of(recordings.begin(), recordings.end(),
                                                            [](const auto& values) { return values.size() > 1; });
  Scatter scatter;
  if (recordings.size() >= kLeastRecordings) {
    const double count = static_cast<double>(means.size());
    answer.of = PairedDifference::Of::kRecordings;
    scatter = {variance_of(means) / count, count - 1.0};
  } else if (has_seeds) {
    answer.of = PairedDifference::Of::kSeeds;
    scatter = scatter_of_seeds(recordings);
  } else {
    return answer;
  }
  const double reach = scatter.variance > 0.0
                           ? student_quantile(0.5 + 0.5 * confidence, scatter.freedom) * std::sqrt(scatter.variance)
                           : 0.0;
  answer.low = answer.mean - reach;
  answer.high = answer.mean + reach;
  return answer;
}

}  // namespace deltamap
