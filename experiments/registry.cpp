// SPDX-License-Identifier: Apache-2.0
#include "experiments/registry.hpp"

#include <algorithm>
#include <cassert>
#include <numeric>
#include <utility>

namespace deltamap::experiments {

std::vector<Experiment> experiments() {
  std::vector<Experiment> all{
      hall_experiment(),         stale_map_experiment(), verdict_experiment(),      fig2_4_experiment(),
      fig6_experiment(),         fig13_experiment(),     fig14_experiment(),        table1_experiment(),
      merge_experiment(),        gate_experiment(),      shifted_hall_experiment(), unseen_experiment(),
      first_map_experiment(),    bent_maps_experiment(), ablation_experiment(),     faults_experiment(),
      good_driving_experiment(), carried_experiment(),   incidents_experiment(),    things_experiment(),
      bays_experiment(),         zones_experiment()};
  for (Experiment& one : changing_world_experiments()) all.push_back(std::move(one));
  return all;
}

std::vector<std::uint64_t> Options::seeds(int whole) const {
  std::vector<std::uint64_t> seeds(static_cast<std::size_t>(repeats.value_or(quick ? 1 : whole)));
  std::iota(seeds.begin(), seeds.end(), seed);
  return seeds;
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
