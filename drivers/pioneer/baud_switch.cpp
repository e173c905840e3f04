// SPDX-License-Identifier: Apache-2.0
#include "drivers/pioneer/baud_switch.hpp"

namespace deltamap::drivers::pioneer {
namespace {

constexpr Duration kBaudPause{10'000'000};  // before and after the change of speed
constexpr Duration kBaudAnswerTimeout{900'000'000};

}  // namespace

bool BaudSwitch::is_due(const Receiver& receiver) const {
  const bool is_allowed = receiver.config() && receiver.config()->auto_baud != 0;
  return is_allowed && !was_tried_ && fast_baud_ != 0 && fast_baud_ != receiver.baud();
}

void BaudSwitch::begin(Transmitter& line) {
  was_tried_ = true;
  slow_baud_ = line.baud();
  step_ = Step::kAnnounced;
  line.commands().push({CommandNumber::kHostBaud, *host_baud_code(fast_baud_)});
  deadline_ = line.now() + kBaudPause;
  line.log("robot line switching baud=" + std::to_string(fast_baud_));
}

void BaudSwitch::hear_packet(Transmitter& line) {
  if (step_ != Step::kAwaitingPacket) return;
  line.log("robot line baud=" + std::to_string(line.baud()));
  step_ = Step::kOver;
}

void BaudSwitch::time_out(Transmitter& line) {
  if (line.now() < deadline_ || !line.commands().is_empty()) return;
  if (step_ == Step::kAnnounced) {
    constexpr std::size_t kAnnouncementSize = 9;
    const Timestamp is_out = *line.commands().last_sent() + line_time(kAnnouncementSize, slow_baud_) + kBaudPause;
    if (line.now() < is_out) {
      deadline_ = is_out;
      return;
    }
    line.set_baud(fast_baud_);
    step_ = Step::kSpeedSet;
    deadline_ = line.now() + kBaudPause;
  } else if (step_ == Step::kSpeedSet) {
    line.commands().push({CommandNumber::kPulse, {}});
    step_ = Step::kAwaitingPacket;
    deadline_ = line.now() + kBaudAnswerTimeout;
  } else if (step_ == Step::kAwaitingPacket) {
    line.log("robot did not follow to baud=" + std::to_string(fast_baud_));
    line.set_baud(slow_baud_);
    step_ = Step::kOver;
  }
}

}  // namespace deltamap::drivers::pioneer
