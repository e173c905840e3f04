// SPDX-License-Identifier: Apache-2.0
// Zones as other programs read them.
#pragma once

#include <string>

#include "core/zones.hpp"

namespace deltamap::daemon {

/// {"ok":true,"zones":[…]}
[[nodiscard]] std::string json_of(const Zones& zones);

}  // namespace deltamap::daemon
