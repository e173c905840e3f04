// SPDX-License-Identifier: Apache-2.0
// Adds the CPU time of the calling thread between its birth and its end.
#pragma once

#include "daemon/telemetry/stage.hpp"

namespace deltamap::daemon {

class CpuTimer {
 public:
  explicit CpuTimer(double& sum_s) : sum_s_{sum_s}, began_s_{thread_cpu_s()} {}
  ~CpuTimer() { sum_s_ += thread_cpu_s() - began_s_; }
  CpuTimer(const CpuTimer&) = delete;
  CpuTimer& operator=(const CpuTimer&) = delete;

 private:
  double& sum_s_;
  double began_s_;
};

}  // namespace deltamap::daemon
