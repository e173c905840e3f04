// SPDX-License-Identifier: Apache-2.0
#include "drivers/lms200/session.hpp"

#include <iterator>
#include <stdexcept>
#include <utility>

#include "drivers/lms200/command.hpp"

namespace deltamap::drivers::lms200 {
namespace {

const Lms200Params& possible_or_throw(const Lms200Params& params) {
  if (!mode_of_baud(params.baud)) {
    throw std::invalid_argument("laser baud " + std::to_string(params.baud) +
                                " is unknown: 9600, 19200, 38400 or 500000");
  }
  if (!is_possible(params.variant)) {
    throw std::invalid_argument("laser variant " + name_of(params.variant) +
                                " is unknown: 180/1, 180/0.5, 100/1, 100/0.5, 100/0.25 or 90/0.5");
  }
  if (params.measuring_mode && !range_coding(*params.measuring_mode)) {
    throw std::invalid_argument("laser measuring mode " + std::to_string(*params.measuring_mode) + " has no ranges");
  }
  return params;
}

}  // namespace

Lms200Session::Lms200Session(const Lms200Params& params, SessionMode mode)
    : params_{possible_or_throw(params)}, mode_{mode}, receiver_{params, mode}, setup_{params}, watch_{params} {}

Lms200Output Lms200Session::start(Timestamp now) {
  Lms200Output out;
  receiver_.forget_mode();
  if (mode_ == SessionMode::kListenOnly) return out;
  Transmitter line{receiver_, now, out.output};
  diagnosis_.reset();
  setup_ = StreamSetup{params_};
  watch_.start(now);
  if (watch_.has_agreement()) {
    begin_visits(line);
  } else {
    state_ = State::kSettingUp;
    setup_.search(params_.baud, line);
  }
  return finished(std::move(out));
}

Lms200Output Lms200Session::on_bytes(std::span<const std::uint8_t> bytes, Timestamp stamp) {
  Lms200Output out;
  Transmitter line{receiver_, stamp, out.output};
  const Receiver::Chunk chunk = receiver_.decode(bytes, stamp);
  for (const Telegram& telegram : chunk.telegrams) {
    take(telegram, out);
    if (state_ != State::kIdle) answer(telegram, line, out.output);
  }
  if (chunk.telegrams.empty()) {
    watch_.take_no_telegram(chunk.has_garbage, stamp);
    if (mode_ == SessionMode::kLive && !is_streaming()) diagnose(bytes, out.output);
  }
  watch_line(stamp, out.output);
  return finished(std::move(out));
}

Lms200Output Lms200Session::on_time(Timestamp now) {
  Lms200Output out;
  if (state_ == State::kIdle || now < deadline()) return finished(std::move(out));
  Transmitter line{receiver_, now, out.output};
  if (state_ == State::kSettingUp) {
    setup_.time_out(line);
  } else {
    watch_.time_out(line);
  }
  go_on(line, out.output);
  return finished(std::move(out));
}

Lms200Output Lms200Session::close(Timestamp now) {
  Lms200Output out;
  if (state_ == State::kIdle) return out;
  Transmitter{receiver_, now, out.output}.write(mode_request(mode::kOnRequest));
  state_ = State::kIdle;
  return out;
}

bool Lms200Session::is_streaming() const {
  return state_ == State::kWatching && watch_.state() == StreamWatch::State::kStreaming;
}

void Lms200Session::take(const Telegram& telegram, Lms200Output& out) {
  if (telegram.kind == Telegram::Kind::kTelegram) diagnosis_.hear_own_frame();
  Receiver::Content content = receiver_.take(telegram);
  if (content.scan) out.scans.push_back(std::move(*content.scan));
  std::move(content.log.begin(), content.log.end(), std::back_inserter(out.output.log));
  std::move(content.warnings.begin(), content.warnings.end(), std::back_inserter(out.output.warnings));
}

void Lms200Session::answer(const Telegram& telegram, Transmitter& line, SessionOutput& out) {
  const bool sets_up = state_ == State::kSettingUp;
  if (telegram.kind == Telegram::Kind::kAck) {
    if (sets_up) setup_.hear_ack();
  } else if (telegram.kind == Telegram::Kind::kNak) {
    sets_up ? setup_.hear_nak(line.now()) : watch_.hear_nak(line.now());
  } else if (telegram.command == response::kPowerOn) {
    watch_.expect_power_on(line.now());
    state_ = State::kSettingUp;
    setup_.set_up_started(line);
  } else {
    sets_up ? setup_.answer(telegram, line) : watch_.answer(telegram, line);
    go_on(line, out);
  }
}

/// Passes the word on where the part that had it is through.
void Lms200Session::go_on(Transmitter& line, SessionOutput& out) {
  if (state_ == State::kSettingUp) {
    go_on_from_setup(line, out);
  } else {
    go_on_from_watch(line, out);
  }
}

void Lms200Session::go_on_from_setup(Transmitter& line, SessionOutput& out) {
  using Result = StreamSetup::Result;
  if (setup_.result() == Result::kStreams) {
    state_ = State::kWatching;
    watch_.begin_stream(line);
  } else if (setup_.result() == Result::kNobodyAnswers) {
    line.log("laser does not answer; listening whether it starts up; " + diagnosis_.phrase());
    begin_visits(line);
  } else if (setup_.result() == Result::kStoppedAnswering) {
    fail("laser has stopped answering while being set up", out);
  }
}

void Lms200Session::go_on_from_watch(Transmitter& line, SessionOutput& out) {
  using Watch = StreamWatch::State;
  if (watch_.state() == Watch::kFellSilent) {
    begin_visits(line);
  } else if (watch_.state() == Watch::kMustBeSetUp) {
    state_ = State::kSettingUp;
    setup_.set_up_known(line);
  } else if (watch_.state() == Watch::kDoesNotHear) {
    state_ = State::kSettingUp;
    setup_.search(line.baud(), line);
  } else if (watch_.state() == Watch::kGivenUp) {
    fail("laser does not answer at " + watch_.visited_bauds() + " baud: " + diagnosis_.phrase(), out);
  }
}

void Lms200Session::begin_visits(Transmitter& line) {
  if (watch_.has_agreement()) diagnosis_.reset();  // else the first round has heard something
  state_ = State::kWatching;
  watch_.begin_visits(line);
}

void Lms200Session::diagnose(std::span<const std::uint8_t> bytes, SessionOutput& out) {
  const bool was_swapped = diagnosis_.is_swapped();
  diagnosis_.hear(bytes);
  if (diagnosis_.is_swapped() && !was_swapped) out.log.push_back(diagnosis_.phrase());
}

void Lms200Session::watch_line(Timestamp now, SessionOutput& out) {
  if (!is_streaming()) return quality_.forget();
  if (const auto change = quality_.observe(receiver_.counts(), now))
    (change->is_disturbed ? out.warnings : out.log).push_back(change->line);
}

void Lms200Session::fail(std::string reason, SessionOutput& out) {
  state_ = State::kIdle;
  out.failed = std::move(reason);
}

Timestamp Lms200Session::deadline() const {
  return state_ == State::kSettingUp ? setup_.deadline() : watch_.deadline();
}

Lms200Output Lms200Session::finished(Lms200Output out) const {
  if (state_ != State::kIdle) out.output.wake_at = deadline();
  return out;
}

}  // namespace deltamap::drivers::lms200
