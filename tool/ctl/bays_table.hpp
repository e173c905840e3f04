// SPDX-License-Identifier: Apache-2.0
// Bays for a person: what `deltamap ctl bays` and `deltamap bays` print.
#pragma once

#include <string>

namespace deltamap::tool {

/// A line a bay and one that sums up, from the list as the daemon answers it.
[[nodiscard]] std::string bays_table(const std::string& list_line);
/// A line a change, from the lines of bays.jsonl.
[[nodiscard]] std::string bay_lines(const std::string& json_lines);

}  // namespace deltamap::tool
