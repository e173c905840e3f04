// SPDX-License-Identifier: Apache-2.0
// The way to a connection (protocols.md A4): at each baud first quiet, then SYNC0, SYNC1, SYNC2, OPEN; later perhaps a
// faster line. Every SYNC0 is preceded by its own ESTOP, VEL 0, RVEL 0 and CLOSE: the ones before may have been lost.
#include <algorithm>
#include <array>
#include <utility>

#include "drivers/pioneer/session.hpp"

namespace deltamap::drivers::pioneer {
namespace {

constexpr std::array<unsigned, 5> kSearchOrder{9600, 38400, 115200, 19200, 57600};  // A4.7
constexpr int kTriesPerBaud = 2;
constexpr Duration kQuietTime{150'000'000};  // a SIP cycle and the rest of a SIP that was on the line
constexpr Duration kEchoTimeout{1'000'000'000};
constexpr Duration kBaudPause{10'000'000};  // before and after the change of speed (A4.8)
constexpr Duration kBaudAnswerTimeout{900'000'000};

}  // namespace

PioneerOutput PioneerSession::start(Timestamp now) {
  PioneerOutput out;
  if (mode_ == SessionMode::kListenOnly) return out;
  bauds_.assign({params_.baud});
  std::copy_if(kSearchOrder.begin(), kSearchOrder.end(), std::back_inserter(bauds_),
               [this](unsigned baud) { return baud != params_.baud; });
  attempt_ = 0;
  set_point_.reset();
  try_baud(now, out);
  return finished(now, std::move(out));
}

void PioneerSession::try_baud(Timestamp now, PioneerOutput& out) {
  if (attempt_ == bauds_.size()) {
    attempt_ = 0;
    std::string tried;
    for (const unsigned baud : bauds_) tried += (tried.empty() ? "" : ", ") + std::to_string(baud);
    fail("robot does not answer at " + tried + " baud", now, out);
    return;
  }
  set_baud(bauds_[attempt_], out);
  tries_ = 0;
  queue_.clear();
  begin_quieting(now);
}

void PioneerSession::begin_quieting(Timestamp now) {
  state_ = State::kQuieting;
  set_point_.reset();
  queue_.push({CommandNumber::kEstop, {}});
  queue_.push({CommandNumber::kVel, 0});
  queue_.push({CommandNumber::kRvel, 0});
  queue_.push({CommandNumber::kClose, {}});
  deadline_ = now + kQuietTime;
}

void PioneerSession::send_sync(std::uint8_t step, Timestamp now) {
  state_ = State::kSyncing;
  sync_step_ = step;
  queue_.push({static_cast<CommandNumber>(step), {}});  // PULSE, OPEN and CLOSE have the bytes of SYNC0 to SYNC2
  deadline_ = now + kEchoTimeout;
}

void PioneerSession::time_out_while_connecting(Timestamp now, PioneerOutput& out) {
  if (state_ == State::kQuieting) {
    if (!queue_.is_empty() || now < *queue_.last_sent() + kQuietTime) {
      if (queue_.is_empty()) deadline_ = *queue_.last_sent() + kQuietTime;
      return;
    }
    out.output.requests.push_back({PortRequest::Kind::kDiscardInput, {}, 0});
    send_sync(kSync0, now);
    return;
  }
  if (now < deadline_) return;
  if (++tries_ < kTriesPerBaud) {
    queue_.clear();
    begin_quieting(now);
  } else {
    ++attempt_;
    try_baud(now, out);
  }
}

void PioneerSession::answer_while_connecting(const Packet& packet, Timestamp now, PioneerOutput& out) {
  switch (state_) {
    case State::kSyncing:
      take_echo(packet, now, out);
      break;
    case State::kOpening:
      if (is_sip(packet.type())) begin_connection(now, out);
      break;
    case State::kSwitching:
      if (switch_step_ == SwitchStep::kAwaitingPacket) {
        out.output.log.push_back("robot line baud=" + std::to_string(baud()));
        last_sip_ = now;
        state_ = State::kConnected;
      }
      break;
    case State::kIdle:
    case State::kQuieting:
    case State::kConnected:
      break;
  }
}

void PioneerSession::take_echo(const Packet& packet, Timestamp now, PioneerOutput& out) {
  const std::uint8_t type = packet.type();
  if (type == sync_step_ && type != kSync2) {
    send_sync(static_cast<std::uint8_t>(sync_step_ + 1), now);
  } else if (type == sync_step_) {
    state_ = State::kOpening;
    queue_.push({CommandNumber::kOpen, {}});
    deadline_ = now + kEchoTimeout;
  } else if (sync_step_ > 0 && type < sync_step_) {
    // An echo that came late: the right one follows.
  } else if (++tries_ > kTriesPerBaud) {
    ++attempt_;
    try_baud(now, out);
  } else {
    if (is_sip(type)) out.output.log.push_back("robot was still connected to a client that has gone: closing it");
    queue_.clear();
    begin_quieting(now);
  }
}

void PioneerSession::begin_connection(Timestamp now, PioneerOutput& out) {
  out.output.log.push_back("robot connected baud=" + std::to_string(baud()));
  state_ = State::kConnected;
  last_sip_ = now;
  config_requests_ = 0;
  sonar_requests_ = 0;
  enable_requests_ = 0;
  may_enable_ = params_.enable_motors && newest_sip_ && !newest_sip_->has(sip_flag::kStopButton);
  switch_tried_ = false;
  next_check_ = now;
  next_pulse_ = now + pulse_interval();
  emergency_stop_.reset();
  set_point_.reset();
  push_set_points();
}

void PioneerSession::begin_switch(Timestamp now, PioneerOutput& out) {
  switch_tried_ = true;
  slow_baud_ = baud();
  state_ = State::kSwitching;
  switch_step_ = SwitchStep::kAnnounced;
  set_point_.reset();
  push_set_points();
  const Command announce{CommandNumber::kHostBaud, *host_baud_code(params_.fast_baud)};
  queue_.push(announce);
  deadline_ = now + kBaudPause;
  out.output.log.push_back("robot line switching baud=" + std::to_string(params_.fast_baud));
}

/// Called with the queue empty and the step's time over.
void PioneerSession::continue_switch(Timestamp now, PioneerOutput& out) {
  switch (switch_step_) {
    case SwitchStep::kAnnounced: {
      constexpr std::size_t kAnnouncementSize = 9;
      const Timestamp is_out = *queue_.last_sent() + line_time(kAnnouncementSize, slow_baud_) + kBaudPause;
      if (now < is_out) {
        deadline_ = is_out;
        return;
      }
      set_baud(params_.fast_baud, out);
      switch_step_ = SwitchStep::kSpeedSet;
      deadline_ = now + kBaudPause;
      return;
    }
    case SwitchStep::kSpeedSet:
      queue_.push({CommandNumber::kPulse, {}});
      switch_step_ = SwitchStep::kAwaitingPacket;
      deadline_ = now + kBaudAnswerTimeout;
      return;
    case SwitchStep::kAwaitingPacket:
      out.output.log.push_back("robot did not follow to baud=" + std::to_string(params_.fast_baud));
      set_baud(slow_baud_, out);
      state_ = State::kConnected;
      last_sip_ = now;
      next_pulse_ = now;
      return;
  }
}

}  // namespace deltamap::drivers::pioneer
