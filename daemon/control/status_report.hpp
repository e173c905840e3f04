// SPDX-License-Identifier: Apache-2.0
// What `deltamap ctl status` answers: one JSON line of everything that telemetry knows.
#pragma once

#include <string>

#include "daemon/settings/settings.hpp"
#include "daemon/telemetry/telemetry.hpp"

namespace deltamap::daemon::control {

[[nodiscard]] std::string status_json_line(const Telemetry& telemetry, const Settings& settings, double since_start_s);

}  // namespace deltamap::daemon::control
