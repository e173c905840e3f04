// SPDX-License-Identifier: Apache-2.0
// The result of a sweep as a page in the look of the reports: words, table with the best marked, charts.
#pragma once

#include <string>
#include <vector>

#include "tool/tune/tuning_result.hpp"

namespace deltamap::tool::tune {

[[nodiscard]] std::string sweep_page(const TuningResult& result, const Ranking& ranking);
/// Of a search: its words, and its winner against the settings as given.
[[nodiscard]] std::string optimize_page(const TuningResult& pairs, const std::vector<std::string>& words);

}  // namespace deltamap::tool::tune
