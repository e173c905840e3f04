// SPDX-License-Identifier: Apache-2.0
#include "experiments/merge/merge_table.hpp"

#include <algorithm>
#include <limits>

namespace deltamap::experiments {
namespace {

constexpr double kRight_cells = 1.0;
constexpr double kRight_deg = 1.0;
constexpr double kWrong_cells = 3.0;
constexpr double kWrong_deg = 1.5;

double greatest(const std::vector<double>& values) {
  return values.empty() ? std::numeric_limits<double>::quiet_NaN() : *std::max_element(values.begin(), values.end());
}

}  // namespace

ScanTable empty_merge_table() {
  return ScanTable{{"true_turn_deg", "acceptance", "true_acceptance", "agreement", "off_cells", "turn_error_deg",
                    "refused", "taken_ms"}};
}

void add_merge(ScanTable& merges, double true_turn_deg, const MergeMeasure& measure, bool is_refused, double taken_ms) {
  merges.add({true_turn_deg, measure.acceptance, measure.true_acceptance, measure.agreement, measure.off_cells,
              measure.turn_deg, is_refused ? 1.0 : 0.0, taken_ms});
}

std::vector<double> shortfalls(const ScanTable& merges) {
  const std::vector<double> acceptance = merges.column("acceptance");
  const std::vector<double> true_acceptance = merges.column("true_acceptance");
  const std::vector<double> refused = merges.column("refused");
  std::vector<double> all;
  for (std::size_t i = 0; i < merges.rows(); ++i) {
    if (refused[i] <= 0.5) all.push_back(true_acceptance[i] - acceptance[i]);
  }
  return all;
}

std::vector<std::pair<std::string, double>> merge_numbers(const ScanTable& merges) {
  const std::vector<double> acceptance = merges.column("acceptance");
  const std::vector<double> true_acceptance = merges.column("true_acceptance");
  const std::vector<double> off_cells = merges.column("off_cells");
  const std::vector<double> turn_deg = merges.column("turn_error_deg");
  const std::vector<double> refused = merges.column("refused");
  const std::vector<double> taken_ms = merges.column("taken_ms");
  const std::vector<double> shortfall = shortfalls(merges);
  std::vector<double> accepted_off;
  std::vector<double> accepted_turn;
  double right = 0.0;
  double wrong = 0.0;
  for (std::size_t i = 0; i < merges.rows(); ++i) {
    right += off_cells[i] <= kRight_cells && turn_deg[i] <= kRight_deg ? 1.0 : 0.0;
    if (refused[i] > 0.5) continue;
    wrong += off_cells[i] > kWrong_cells || turn_deg[i] > kWrong_deg ? 1.0 : 0.0;
    accepted_off.push_back(off_cells[i]);
    accepted_turn.push_back(turn_deg[i]);
  }
  const auto all = static_cast<double>(merges.rows());
  return {{"transforms", all},
          {"acceptance", mean_of(acceptance)},
          {"least_acceptance", acceptance.empty() ? 0.0 : *std::min_element(acceptance.begin(), acceptance.end())},
          {"true_acceptance", mean_of(true_acceptance)},
          {"agreement", mean_of(merges.column("agreement"))},
          {"short_of_truth", mean_of(shortfall)},
          {"most_short_of_truth", greatest(shortfall)},
          {"right", right / all},
          {"refused", share_above(refused, 0.5)},
          {"wrong_not_refused", wrong},
          {"off_cells", mean_of(accepted_off)},
          {"off_cells_p99", quantile(accepted_off, 0.99)},
          {"turn_error_deg", mean_of(accepted_turn)},
          {"mean_ms", mean_of(taken_ms)},
          {"p99_ms", quantile(taken_ms, 0.99)}};
}

PooledRuns pooled_merges(const std::vector<Outcome>& outcomes,
                         const std::vector<std::pair<std::string, std::string>>& labels) {
  return {runs_with(outcomes, labels), merge_numbers};
}

Outcome together(const ScanTable& merges) {
  Outcome all;
  all.numbers = merge_numbers(merges);
  return all;
}

ScanTable merges_of(const std::vector<Outcome>& outcomes,
                    const std::vector<std::pair<std::string, std::string>>& labels) {
  return rows_of(runs_with(outcomes, labels));
}

}  // namespace deltamap::experiments
