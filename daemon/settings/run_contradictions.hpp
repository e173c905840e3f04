// SPDX-License-Identifier: Apache-2.0
// What the settings of a running daemon must not be: an output in place of the first map or of another file that they
// name, one port for both devices. A replay has neither ports nor outputs of the settings, and is not asked.
#pragma once

#include <string>
#include <vector>

#include "daemon/settings/settings.hpp"

namespace deltamap::daemon {

/// `file` is where the settings came from. Files count as one by whatever links lead to them.
[[nodiscard]] std::vector<Contradiction> contradictions_in_a_run(const Settings& settings, const std::string& file);

}  // namespace deltamap::daemon
