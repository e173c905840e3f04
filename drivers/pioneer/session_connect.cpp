// SPDX-License-Identifier: Apache-2.0
// The way to a connection (protocols.md A4): at each baud first quiet, then SYNC0, SYNC1, SYNC2, OPEN; later perhaps a
// faster line. Every SYNC0 is preceded by its own ESTOP, VEL 0 and RVEL 0: the ones before may have been lost. A robot
// that answers with SIPs is still connected to a client that has gone: it is stopped, looked at, closed, and then waits
// at its idle baud.
#include <algorithm>
#include <utility>

#include "drivers/pioneer/session.hpp"

namespace deltamap::drivers::pioneer {
namespace {

constexpr int kTriesPerProbe = 2;              // once SYNC0 was answered
constexpr int kMaxClosings = 5;                // CLOSE may be lost
constexpr Duration kQuietTime{150'000'000};    // a SIP cycle and the rest of a SIP that was on the line
constexpr Duration kObserveTime{500'000'000};  // a SIP cycle, and a long SIP at 9600 baud; one may be lost
constexpr Duration kEchoTimeout{1'000'000'000};
constexpr std::uint64_t kBytesAtAnotherSpeed = 30;  // more than noise and the rest of a packet: a SIP has at least 24
constexpr Duration kBaudPause{10'000'000};          // before and after the change of speed (A4.8)
constexpr Duration kBaudAnswerTimeout{900'000'000};

std::string listed(const std::vector<BaudProbe>& probes) {
  std::vector<unsigned> bauds;
  std::string text;
  for (const BaudProbe& probe : probes) {
    if (std::find(bauds.begin(), bauds.end(), probe.baud) != bauds.end()) continue;
    bauds.push_back(probe.baud);
    text += (text.empty() ? "" : ", ") + std::to_string(probe.baud);
  }
  return text;
}

}  // namespace

PioneerOutput PioneerSession::start(Timestamp now) {
  PioneerOutput out;
  if (mode_ == SessionMode::kListenOnly) return out;
  probes_ = baud_search(idle_baud_, connected_baud_);
  probe_ = 0;
  closings_ = 0;
  diagnosis_.reset();
  probe(now, out);
  return finished(now, std::move(out));
}

void PioneerSession::probe(Timestamp now, PioneerOutput& out) {
  if (probe_ == probes_.size()) {
    was_in_vain_ = true;
    return leave("robot does not answer at " + listed(probes_) + " baud: " + diagnosis_.phrase());
  }
  set_baud(probes_[probe_].baud, out);
  if (was_in_vain_) {
    const std::vector<std::uint8_t> question = LineDiagnosis::question_to_a_laser();
    queue_.hold_for(question.size(), now, baud());
    out.output.requests.push_back({PortRequest::Kind::kWrite, question, 0});
  }
  tries_ = 0;
  begin_quieting();
  deadline_ = now + kQuietTime;
}

void PioneerSession::probe_next(Timestamp now, PioneerOutput& out) {
  ++probe_;
  probe(now, out);
}

void PioneerSession::push_stop() {
  queue_.clear();
  set_point_.reset();
  queue_.push({CommandNumber::kEstop, {}});
  queue_.push({CommandNumber::kVel, 0});
  queue_.push({CommandNumber::kRvel, 0});
}

void PioneerSession::begin_quieting() {
  state_ = State::kQuieting;
  push_stop();
}

void PioneerSession::stop_left_over(Timestamp now, PioneerOutput& out) {
  if (++closings_ > kMaxClosings) return leave("robot stays connected to a client that has gone");
  if (closings_ == 1) out.output.log.push_back("robot was still connected to a client that has gone: closing it");
  state_ = State::kObserving;
  push_stop();
  deadline_ = now + kObserveTime;
}

/// CLOSE switches the motors off. What a button has done must be seen before: at once after a SIP that is younger than
/// the stop, there is the least time for a person to be overlooked.
void PioneerSession::close_left_over(const Packet& sip, Timestamp now) {
  const bool is_younger = queue_.is_empty() && sip.first_byte > *queue_.last_sent();
  if (!is_younger) return;
  state_ = State::kClosing;
  queue_.push({CommandNumber::kClose, {}});
  deadline_ = now + kQuietTime;
}

void PioneerSession::send_sync(std::uint8_t step, Timestamp now) {
  state_ = State::kSyncing;
  sync_step_ = step;
  garbage_before_ = decoder_.counts().garbage_bytes;
  queue_.push({static_cast<CommandNumber>(step), {}});  // PULSE, OPEN and CLOSE have the bytes of SYNC0 to SYNC2
  deadline_ = now + (step == kSync0 && tries_ == 0 ? probes_[probe_].echo_timeout : kEchoTimeout);
}

void PioneerSession::time_out_while_connecting(Timestamp now, PioneerOutput& out) {
  if (state_ == State::kObserving) {  // it has fallen silent
    if (queue_.is_empty() && now >= deadline_) begin_quieting();
    return;
  }
  if (state_ == State::kQuieting || state_ == State::kClosing) {
    if (!queue_.is_empty() || now < *queue_.last_sent() + kQuietTime) {
      if (queue_.is_empty()) deadline_ = *queue_.last_sent() + kQuietTime;
      return;
    }
    if (state_ == State::kClosing) {  // it has gone back to its idle baud
      probe_ = 0;
      return probe(now, out);
    }
    out.output.requests.push_back({PortRequest::Kind::kDiscardInput, {}, 0});
    send_sync(kSync0, now);
    return;
  }
  if (now < deadline_) return;
  const bool somebody_answers = state_ == State::kOpening || sync_step_ > kSync0;
  if (somebody_answers && ++tries_ < kTriesPerProbe) return begin_quieting();
  probe_next(now, out);
}

void PioneerSession::answer_while_connecting(const Packet& packet, Timestamp now, PioneerOutput& out) {
  switch (state_) {
    case State::kQuieting:
      if (is_sip(packet.type())) stop_left_over(now, out);
      break;
    case State::kObserving:
      if (is_sip(packet.type())) close_left_over(packet, now);
      break;
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
    case State::kClosing:  // SIPs that were under way
    case State::kConnected:
    case State::kLeaving:
      break;
  }
}

void PioneerSession::take_echo(const Packet& packet, Timestamp now, PioneerOutput& out) {
  const std::uint8_t type = packet.type();
  if (type == sync_step_ && type != kSync2) {
    send_sync(static_cast<std::uint8_t>(sync_step_ + 1), now);
  } else if (type == sync_step_) {
    idle_baud_ = baud();
    state_ = State::kOpening;
    queue_.push({CommandNumber::kOpen, {}});
    deadline_ = now + kEchoTimeout;
  } else if (is_sip(type)) {
    stop_left_over(now, out);
  } else if (sync_step_ > 0 && type < sync_step_) {
    // An echo that came late: the right one follows.
  } else if (++tries_ > kTriesPerProbe) {
    probe_next(now, out);
  } else {
    begin_quieting();
  }
}

/// Bytes that are no packets: a robot that sends SIPs at another speed. Not worth the whole wait for an echo.
void PioneerSession::notice_another_speed(Timestamp now) {
  if (state_ != State::kSyncing || sync_step_ != kSync0) return;
  if (decoder_.counts().garbage_bytes - garbage_before_ > kBytesAtAnotherSpeed) deadline_ = std::min(deadline_, now);
}

void PioneerSession::begin_connection(Timestamp now, PioneerOutput& out) {
  out.output.log.push_back("robot connected baud=" + std::to_string(baud()));
  if (params_.enable_motors && !permission_.holds()) {
    const bool by_operator = permission_.drive_switch() == DriveSwitch::kOffByOperator;
    out.output.log.push_back("robot stands: driving is " + std::string(name_of(permission_.drive_switch())) + ": " +
                             (by_operator ? "" : "press MOTORS, or ") + "`deltamap ctl drive wander`");
  }
  state_ = State::kConnected;
  was_in_vain_ = false;
  connected_baud_ = baud();
  last_sip_ = now;
  limit_requests_ = 0;
  sonar_requests_ = 0;
  disable_requests_ = 0;
  limits_are_told_ = false;
  enable_was_sent_ = false;
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
  connected_baud_ = params_.fast_baud;
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
      connected_baud_ = slow_baud_;
      state_ = State::kConnected;
      last_sip_ = now;
      next_pulse_ = now;
      return;
  }
}

}  // namespace deltamap::drivers::pioneer
