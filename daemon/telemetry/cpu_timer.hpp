// SPDX-License-Identifier: Apache-2.0
// Adds the CPU time of the calling thread between its birth and its end; nothing, and asks no clock, where it is not
// on.
#pragma once

#include "daemon/telemetry/stage.hpp"

namespace deltamap::daemon {

class CpuTimer {
 public:
  explicit CpuTimer(double& sum_s, bool is_on = true)
      : sum_s_{sum_s}, is_on_{is_on}, began_s_{is_on ? thread_cpu_s() : 0.0} {}
  ~CpuTimer() {
    if (is_on_) sum_s_ += thread_cpu_s() - began_s_;
  }
  CpuTimer(const CpuTimer&) = delete;
  CpuTimer& operator=(const CpuTimer&) = delete;

 private:
  double& sum_s_;
  bool is_on_;
  double began_s_;
};

}  // namespace deltamap::daemon
