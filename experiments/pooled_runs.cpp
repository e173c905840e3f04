// SPDX-License-Identifier: Apache-2.0
#include "experiments/pooled_runs.hpp"

#include <algorithm>

namespace deltamap::experiments {
namespace {

std::vector<double> values_of(const PooledRuns::Numbers& numbers) {
  std::vector<double> values;
  for (const auto& [name, value] : numbers) values.push_back(value);
  return values;
}

}  // namespace

std::vector<const Outcome*> runs_with(const std::vector<Outcome>& outcomes,
                                      const std::vector<std::pair<std::string, std::string>>& labels) {
  std::vector<const Outcome*> runs;
  for (const Outcome& outcome : outcomes) {
    const bool fits = std::all_of(labels.begin(), labels.end(),
                                  [&](const auto& label) { return outcome.label(label.first) == label.second; });
    if (fits) runs.push_back(&outcome);
  }
  return runs;
}

ScanTable rows_of(const std::vector<const Outcome*>& runs) {
  if (runs.empty()) return {};
  ScanTable all{runs.front()->scans.columns()};
  std::vector<double> row(all.columns().size());
  for (const Outcome* run : runs) {
    for (std::size_t i = 0; i < run->scans.rows(); ++i) {
      for (std::size_t column = 0; column < row.size(); ++column) row[column] = run->scans.at(i, column);
      all.add(row);
    }
  }
  return all;
}

void add_pictures(Report& report, const std::string& where, const Outcome& run) {
  for (const Picture& picture : run.pictures)
    report.pictures.push_back({where + ", seed " + run.label("seed") + ": " + picture.title, picture.svg});
}

PooledRuns::PooledRuns(std::vector<const Outcome*> runs, const std::function<Numbers(const ScanTable&)>& numbers_of)
    : runs_{std::move(runs)} {
  if (runs_.empty()) return;
  all_.numbers = numbers_of(rows_of(runs_));
  certainties_ = certainties_of_runs(runs_.size(), [&](const std::vector<std::size_t>& drawn) {
    std::vector<const Outcome*> chosen;
    chosen.reserve(drawn.size());
    for (const std::size_t run : drawn) chosen.push_back(runs_[run]);
    return values_of(numbers_of(rows_of(chosen)));
  });
}

Figure PooledRuns::figure(const std::string& name, const std::string& number, const std::string& unit,
                          const std::optional<Target>& target, const std::string& peers) const {
  const auto found =
      std::find_if(all_.numbers.begin(), all_.numbers.end(), [&](const auto& one) { return one.first == number; });
  return {name,  this->number(number),
          unit,  target,
          peers, certainties_.at(static_cast<std::size_t>(found - all_.numbers.begin()))};
}

Figure PooledRuns::figure_of_extreme(const std::string& name, const std::string& number, const std::string& unit,
                                     const std::optional<Target>& target, const std::string& peers) const {
  return {name, this->number(number), unit, target, peers, Certainty{.runs = runs_.size()}};
}

}  // namespace deltamap::experiments
