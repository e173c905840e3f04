// SPDX-License-Identifier: Apache-2.0
// The daemon's status for a person: what `deltamap ctl status` prints.
#pragma once

#include <string>

namespace deltamap::tool {

/// A line a topic, from the daemon's reply; a value that the reply lacks is 0 or "-".
[[nodiscard]] std::string status_table(const std::string& reply_line);

}  // namespace deltamap::tool
