// SPDX-License-Identifier: Apache-2.0
// The daemon's status for a person: what `deltamap ctl status` prints.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>

namespace deltamap::daemon::tool {

/// A line a topic. Values that the reply lacks are left out.
[[nodiscard]] std::string status_table(const nlohmann::ordered_json& status);

}  // namespace deltamap::daemon::tool
