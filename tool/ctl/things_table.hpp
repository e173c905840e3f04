// SPDX-License-Identifier: Apache-2.0
// Things for a person: what `deltamap ctl things` and `deltamap things` print.
#pragma once

#include <string>

namespace deltamap::tool {

/// A line a thing and one that sums up, from the list as the daemon answers it.
[[nodiscard]] std::string things_table(const std::string& list_line);

}  // namespace deltamap::tool
