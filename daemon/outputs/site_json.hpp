// SPDX-License-Identifier: Apache-2.0
// Bays and zones as their files list them, for whoever draws.
#pragma once

#include <string>

#include "daemon/settings/settings.hpp"
#include "daemon/site/site.hpp"

namespace deltamap::daemon {

/// {"ok":true,"bays":{"file":…,"version":…,"places":[…]},"zones":{…}}; corners as [x, y], m in the map frame.
[[nodiscard]] std::string json_of(const Site& site, const Settings& settings);

}  // namespace deltamap::daemon
