// SPDX-License-Identifier: Apache-2.0
#include "drivers/pioneer/farewell.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace deltamap::drivers::pioneer {
namespace {

constexpr double kControllerCycleS = 0.1;  // A6: so old the newest speed may be
constexpr double kLongestBrakingS = 3.0;   // waited for before CLOSE, whatever the controller reports

double time_to_stand_s(const Receiver& robot) {
  const std::optional<Sip>& sip = robot.newest_sip();
  if (!sip) return 0.0;
  const double faster_m_per_s = 1e-3 * std::max(std::abs(sip->left_mm_per_s), std::abs(sip->right_mm_per_s));
  if (faster_m_per_s == 0.0) return 0.0;
  return faster_m_per_s / robot.stopping_limits().deceleration_m_per_s2 + kControllerCycleS;
}

}  // namespace

void Farewell::begin_after_failure(std::string reason, Transmitter& line) {
  line.commands().push_only_stop();
  *this = {};
  reason_ = std::move(reason);
}

void Farewell::begin(bool has_opened, Transmitter& line) {
  line.commands().push_only_stop();
  const double to_stand_s = time_to_stand_s(line.receiver());
  reason_.reset();
  owes_close_ = has_opened && to_stand_s <= kLongestBrakingS;
  close_at_ = line.now() + duration_from_seconds(std::min(to_stand_s, kLongestBrakingS));
  if (has_opened && !owes_close_) {
    line.log("robot is told to stop and not let go: by what it reports it stands in " +
             std::to_string(std::lround(to_stand_s)) + " s; its motors stay on, and hold it, until the next start");
  }
}

bool Farewell::pushes_close(Transmitter& line) {
  if (!owes_close_ || !line.commands().is_empty() || line.now() < close_at_) return false;
  owes_close_ = false;
  line.commands().push({CommandNumber::kClose, {}});
  return true;
}

}  // namespace deltamap::drivers::pioneer
