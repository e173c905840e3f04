// SPDX-License-Identifier: Apache-2.0
#include "tool/tune/measures.hpp"

#include <algorithm>
#include <array>
#include <stdexcept>

#include "daemon/settings/reader/nearest_key.hpp"

namespace deltamap::tool::tune {
namespace {

constexpr std::array kMeasures{
    Measure{"error_rmse_m", "m", Better::kLess, "root mean square distance from the reference"},
    Measure{"error_median_m", "m", Better::kLess, "median distance from the reference"},
    Measure{"error_p95_m", "m", Better::kLess, "distance that 95 % of the poses stay within"},
    Measure{"error_max_m", "m", Better::kLess, "largest distance from the reference"},
    Measure{"heading_median_deg", "deg", Better::kLess, "median turn from the reference"},
    Measure{"lost_share", "", Better::kLess, "share of the reference without an estimate within 0.5 m"},
    Measure{"relation_m", "m", Better::kLess, "mean error of measured relations, translation"},
    Measure{"relation_deg", "deg", Better::kLess, "mean error of measured relations, rotation"},
    Measure{"agreement", "", Better::kMore,
            "share of beam ends within 0.1 m of a surface of the map written afterwards"},
    Measure{"n_eff", "", Better::kMore, "effective sample size, mean over the scans"},
    Measure{"right_share", "", Better::kMore, "share of the time with the verdict right"},
    Measure{"undecided_share", "", Better::kLess, "share of the time with the verdict undecided"},
    Measure{"wrong_share", "", Better::kLess, "share of the time with the verdict wrong"},
    Measure{"untracked_share", "", Better::kLess, "share of the time in the states global and lost"},
    Measure{"repeatability_m", "m", Better::kLess, "distance of the seeds' poses from their middle, root mean square"},
    Measure{"revisions", "", Better::kNeither, "revisions of the map"},
    Measure{"refused", "", Better::kNeither, "delta phases that were refused"},
    Measure{"cpu_ms", "ms", Better::kLess, "CPU time a scan"},
};

}  // namespace

std::span<const Measure> measures() { return kMeasures; }

const Measure& measure_named(const std::string& name) {
  const auto found =
      std::find_if(kMeasures.begin(), kMeasures.end(), [&](const Measure& one) { return one.name == name; });
  if (found != kMeasures.end()) return *found;
  std::vector<std::string> names;
  for (const Measure& one : kMeasures) names.emplace_back(one.name);
  const auto nearest = daemon::nearest_of(names, name);
  std::string all;
  for (const std::string& one : names) all += (all.empty() ? "" : ", ") + one;
  throw std::runtime_error("unknown measure '" + name + "' (" + (nearest ? "nearest " + *nearest : "there are " + all) +
                           ")");
}

double number_of(const Numbers& numbers, std::string_view name) {
  const auto found = std::find_if(numbers.begin(), numbers.end(), [&](const auto& one) { return one.first == name; });
  return found == numbers.end() ? std::numeric_limits<double>::quiet_NaN() : found->second;
}

}  // namespace deltamap::tool::tune
