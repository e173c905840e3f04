// SPDX-License-Identifier: Apache-2.0
#include "experiments/registry.hpp"

#include <algorithm>
#include <cassert>

namespace deltamap::experiments {

std::vector<std::unique_ptr<Experiment>> experiments() {
  std::vector<std::unique_ptr<Experiment>> all;
  all.push_back(hall_experiment());
  all.push_back(stale_map_experiment());
  all.push_back(verdict_experiment());
  all.push_back(fig2_4_experiment());
  all.push_back(fig6_experiment());
  all.push_back(fig13_experiment());
  all.push_back(fig14_experiment());
  all.push_back(table1_experiment());
  all.push_back(merge_experiment());
  all.push_back(gate_experiment());
  all.push_back(shifted_hall_experiment());
  all.push_back(unseen_experiment());
  for (auto& one : changing_world_experiments()) all.push_back(std::move(one));
  return all;
}

const std::string& Outcome::label(std::string_view name) const {
  const auto found = std::find_if(labels.begin(), labels.end(), [&](const auto& pair) { return pair.first == name; });
  assert(found != labels.end() && "the label exists");
  return found->second;
}

double Outcome::number(std::string_view name) const {
  const auto found = std::find_if(numbers.begin(), numbers.end(), [&](const auto& pair) { return pair.first == name; });
  assert(found != numbers.end() && "the number exists");
  return found->second;
}

}  // namespace deltamap::experiments
