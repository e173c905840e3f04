// SPDX-License-Identifier: Apache-2.0
#include "daemon/stages/gate_watch.hpp"

#include <cmath>
#include <string>
#include <utility>

namespace deltamap::daemon {
namespace {

constexpr double kShutForLong_s = 60.0;

std::string text_of(double time_s) { return std::to_string(std::lround(time_s)) + " s"; }

}  // namespace

LogLine GateWatch::observe(const mapping::Awareness& awareness) {
  if (awareness.gate == mapping::gate::GateReason::kOpen) {
    if (!std::exchange(said_, false)) return {};
    return {"map is written again: the gate was closed for " + text_of(shut_for_s_)};
  }
  shut_for_s_ = awareness.gate_shut_for_s;
  if (said_ || shut_for_s_ < kShutForLong_s) return {};
  said_ = true;
  return {"map is not written: the gate is closed for " + text_of(shut_for_s_) +
              " reason=" + std::string(name_of(awareness.gate)),
          true};
}

}  // namespace deltamap::daemon
