// SPDX-License-Identifier: Apache-2.0
#include "drivers/port/reconnect.hpp"

#include <algorithm>

#include "core/counted.hpp"

namespace deltamap::drivers::port {

Reconnect::Pause Reconnect::failed(std::string reason, Timestamp now) {
  pause_s_ = pause_s_ == 0.0 ? params_.first_pause_s : std::min(pause_s_ * params_.growth, params_.longest_pause_s);
  ++failures_;
  Pause pause{now + duration_from_seconds(pause_s_), std::nullopt};
  if (reason != told_) {
    told_ = std::move(reason);
    pause.log = told_ + "; trying again";
  }
  return pause;
}

std::optional<std::string> Reconnect::connected() {
  if (failures_ == 0) return std::nullopt;
  std::string log = "connected again after " + counted(failures_, "failure");
  failures_ = 0;
  pause_s_ = 0.0;
  told_.clear();
  return log;
}

}  // namespace deltamap::drivers::port
