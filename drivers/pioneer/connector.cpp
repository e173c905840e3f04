// SPDX-License-Identifier: Apache-2.0
#include "drivers/pioneer/connector.hpp"

#include <algorithm>
#include <utility>

#include "drivers/line_diagnosis.hpp"

namespace deltamap::drivers::pioneer {
namespace {

constexpr int kTriesPerProbe = 2;              // once SYNC0 was answered
constexpr int kMaxClosings = 5;                // CLOSE may be lost
constexpr Duration kQuietTime{150'000'000};    // a SIP cycle and the rest of a SIP that was on the line
constexpr Duration kObserveTime{500'000'000};  // a SIP cycle, and a long SIP at 9600 baud; one may be lost
constexpr Duration kEchoTimeout{1'000'000'000};
constexpr std::uint64_t kBytesAtAnotherSpeed = 30;  // more than noise and the rest of a packet: a SIP has at least 24

}  // namespace

void Connector::start(Transmitter& line) {
  probes_ = baud_search(idle_baud_, connected_baud_, wanted_baud_);
  probe_ = 0;
  closings_ = 0;
  result_ = Result::kPending;
  probe(line);
}

void Connector::probe(Transmitter& line) {
  if (probe_ == probes_.size()) {
    was_in_vain_ = true;
    result_ = Result::kNobodyAnswers;
    return;
  }
  line.set_baud(probes_[probe_].baud);
  if (was_in_vain_) {
    std::vector<std::uint8_t> question = LineDiagnosis::question_to_a_laser();
    line.commands().hold_for(question.size(), line.now(), line.baud());
    line.write(std::move(question));
  }
  tries_ = 0;
  begin_quieting(line);
  deadline_ = line.now() + kQuietTime;
}

void Connector::probe_next(Transmitter& line) {
  ++probe_;
  probe(line);
}

void Connector::begin_quieting(Transmitter& line) {
  state_ = State::kQuieting;
  line.commands().push_only_stop();
}

void Connector::stop_left_over(Transmitter& line) {
  if (++closings_ > kMaxClosings) {
    result_ = Result::kStaysConnected;
    return;
  }
  if (closings_ == 1) line.log("robot was still connected to a client that has gone: closing it");
  state_ = State::kObserving;
  line.commands().push_only_stop();
  deadline_ = line.now() + kObserveTime;
}

/// CLOSE switches the motors off. What a button has done must be seen before: at once after a SIP that is younger than
/// the stop, there is the least time for a person to be overlooked.
void Connector::close_left_over(const Packet& sip, Transmitter& line) {
  const bool is_younger = line.commands().is_empty() && sip.first_byte > *line.commands().last_sent();
  if (!is_younger) return;
  state_ = State::kClosing;
  line.commands().push({CommandNumber::kClose, {}});
  deadline_ = line.now() + kQuietTime;
}

void Connector::send_sync(std::uint8_t step, Transmitter& line) {
  state_ = State::kSyncing;
  sync_step_ = step;
  garbage_before_ = line.receiver().counts().garbage_bytes;
  line.commands().push({static_cast<CommandNumber>(step), {}});  // PULSE, OPEN, CLOSE have the bytes of SYNC0 to SYNC2
  deadline_ = line.now() + (step == kSync0 && tries_ == 0 ? probes_[probe_].echo_timeout : kEchoTimeout);
}

void Connector::time_out(Transmitter& line) {
  if (state_ == State::kObserving) {  // it has fallen silent
    if (line.commands().is_empty() && line.now() >= deadline_) begin_quieting(line);
  } else if (state_ == State::kQuieting || state_ == State::kClosing) {
    if (!line.commands().is_empty()) return;
    deadline_ = *line.commands().last_sent() + kQuietTime;
    if (line.now() >= deadline_) end_quiet(line);
  } else if (line.now() >= deadline_) {
    const bool somebody_answers = state_ == State::kOpening || sync_step_ > kSync0;
    if (somebody_answers && ++tries_ < kTriesPerProbe) return begin_quieting(line);
    probe_next(line);
  }
}

void Connector::end_quiet(Transmitter& line) {
  if (state_ == State::kClosing) {  // it has gone back to its idle baud: where robots wait, or where this one was found
    probes_ = baud_search(home_baud_, idle_baud_, wanted_baud_);
    probe_ = 0;
    return probe(line);
  }
  line.discard_input();
  send_sync(kSync0, line);
}

void Connector::hear(const Packet& packet, Transmitter& line) {
  if (state_ == State::kSyncing) return take_echo(packet, line);
  if (!is_sip(packet.type())) return;
  if (state_ == State::kQuieting) {
    stop_left_over(line);
  } else if (state_ == State::kObserving) {
    close_left_over(packet, line);
  } else if (state_ == State::kOpening) {
    result_ = Result::kConnected;
    was_in_vain_ = false;
    connected_baud_ = line.baud();
  }
}

void Connector::take_echo(const Packet& packet, Transmitter& line) {
  const std::uint8_t type = packet.type();
  if (type == sync_step_ && type != kSync2) {
    send_sync(static_cast<std::uint8_t>(sync_step_ + 1), line);
  } else if (type == sync_step_) {
    idle_baud_ = line.baud();
    state_ = State::kOpening;
    line.commands().push({CommandNumber::kOpen, {}});
    deadline_ = line.now() + kEchoTimeout;
  } else if (is_sip(type)) {
    stop_left_over(line);
  } else if (sync_step_ > 0 && type < sync_step_) {
    // An echo that came late: the right one follows.
  } else if (++tries_ > kTriesPerProbe) {
    probe_next(line);
  } else {
    begin_quieting(line);
  }
}

void Connector::notice_another_speed(const Receiver& receiver, Timestamp now) {
  if (state_ != State::kSyncing || sync_step_ != kSync0) return;
  const std::uint64_t garbage = receiver.counts().garbage_bytes - garbage_before_;
  if (garbage > kBytesAtAnotherSpeed) deadline_ = std::min(deadline_, now);
}

bool Connector::waits_for_queue() const {
  return state_ == State::kQuieting || state_ == State::kObserving || state_ == State::kClosing;
}

std::string Connector::tried_bauds() const {
  std::vector<unsigned> bauds;
  std::string text;
  for (const BaudProbe& probe : probes_) {
    if (std::find(bauds.begin(), bauds.end(), probe.baud) != bauds.end()) continue;
    bauds.push_back(probe.baud);
    text += (text.empty() ? "" : ", ") + std::to_string(probe.baud);
  }
  return text;
}

}  // namespace deltamap::drivers::pioneer
