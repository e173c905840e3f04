// SPDX-License-Identifier: Apache-2.0
// Says in the log when the write gate has been closed for a minute, and when it is open again after that.
#pragma once

#include "daemon/telemetry/log_line.hpp"
#include "mapping/store_scan.hpp"

namespace deltamap::daemon {

class GateWatch {
 public:
  /// After each scan: a line for the log, a warning that the gate is closed; empty where there is nothing to say.
  [[nodiscard]] LogLine observe(const mapping::Awareness& awareness);

 private:
  bool said_ = false;
  double shut_for_s_ = 0.0;
};

}  // namespace deltamap::daemon
