// SPDX-License-Identifier: Apache-2.0
// /metrics of the live page: what telemetry knows, in Prometheus' text format (version 0.0.4).
#pragma once

#include <string>

#include "daemon/telemetry/telemetry.hpp"

namespace deltamap::daemon {

[[nodiscard]] std::string metrics_text(const Telemetry& telemetry, double since_start_s);

}  // namespace deltamap::daemon
