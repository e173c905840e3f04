// SPDX-License-Identifier: Apache-2.0
// The conversation that brings any laser to stream as wanted (protocols.md B8). Every step asks again where no answer
// comes, because requests get lost at certain mirror positions (B1), and ACKs are not waited for: the answer proves
// more.
#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "drivers/lms200/session.hpp"

namespace deltamap::drivers::lms200 {
namespace {

constexpr std::array<unsigned, 4> kSearchOrder{38400, 9600, 500000, 19200};  // B8
constexpr double kStopPauseS = 0.1;                                          // B8: then what was on the line is through
constexpr double kStatusTimeoutS = 0.4;                                      // 160 bytes take 0.25 s at 9600 (B1)
constexpr double kSettlePauseS = 0.45;    // B3: 75 to 434 ms until usable at a new baud
constexpr double kPauseAfterNakS = 0.04;  // B1: at least 30 ms
constexpr int kMaxInterruptions = 10;
constexpr int kMaxNaks = 10;
constexpr int kMaxWrites = 2;  // the EEPROM stands some thousands

}  // namespace

Lms200Output Lms200Session::start(Timestamp now) {
  Lms200Output out;
  known_mode_.reset();  // whoever is on the line now may measure in another one: no scan before its status
  if (mode_ == SessionMode::kListenOnly) return out;
  writes_ = 0;
  diagnosis_.reset();
  search_began_ = now;
  last_scan_ = now;
  silence_told_ = !agreement_;
  if (agreement_) {
    begin_watch(now, out);
  } else {
    may_change_baud_ = true;
    may_change_variant_ = true;
    search_from(params_.baud);
    try_baud(now, out);
  }
  return finished(std::move(out));
}

void Lms200Session::search_from(unsigned first_baud) {
  bauds_.assign({first_baud});
  std::copy_if(kSearchOrder.begin(), kSearchOrder.end(), std::back_inserter(bauds_),
               [first_baud](unsigned baud) { return baud != first_baud; });
  attempt_ = 0;
}

Lms200Session::Step Lms200Session::step_of(State state) const {
  switch (state) {
    case State::kStopping:
      return {mode_request(mode::kOnRequest), kStopPauseS, 1};
    case State::kProbing:
      return {status_request(), kStatusTimeoutS, 3};
    case State::kWatching:
      return {status_request(), kStatusTimeoutS + (baud() == home_baud_ ? nominal_period_s() : 0.0), 1};
    case State::kSettingBaud:
      return {baud_request(params_.baud), 1.0, 3};
    case State::kSettling:
      return {{}, kSettlePauseS, 1};
    case State::kSettingVariant:
      return {variant_request(params_.variant), 1.5, 4};
    case State::kReadingConfiguration:
    case State::kVerifyingConfiguration:
      return {configuration_request(), 1.0, 4};
    case State::kEnteringInstallation:
      return {installation_request(), 3.0, 3};
    case State::kWritingConfiguration:
      return {write_configuration_request(wanted_configuration()), 15.0, 1};  // what came of it is read afterwards
    case State::kStarting:
      return {mode_request(mode::kStreamAll), 1.5, 4};
    case State::kIdle:
    case State::kStreaming:
      break;
  }
  return {};
}

void Lms200Session::begin_step(State state, Timestamp now, Lms200Output& out) {
  state_ = state;
  tries_ = 0;
  naks_ = 0;
  send_step(now, out);
}

void Lms200Session::send_step(Timestamp now, Lms200Output& out) {
  Step step = step_of(state_);
  const Duration on_the_line = line_time(step.request.size(), baud());
  ++tries_;
  repeats_after_nak_ = false;
  deadline_ = now + on_the_line + duration_from_seconds(step.timeout_s);
  if (!step.request.empty()) write(std::move(step.request), out);
}

void Lms200Session::try_baud(Timestamp now, Lms200Output& out) {
  interruptions_ = 0;
  set_baud(bauds_[attempt_], out);
  begin_step(State::kStopping, now, out);
}

void Lms200Session::next_baud(Timestamp now, Lms200Output& out) {
  if (++attempt_ < bauds_.size()) {
    try_baud(now, out);
    return;
  }
  attempt_ = 0;
  out.output.log.push_back("laser does not answer; listening whether it starts up; " + diagnosis_.phrase());
  begin_watch(now, out);
}

Lms200Output Lms200Session::on_time(Timestamp now) {
  Lms200Output out;
  if (mode_ == SessionMode::kLive && state_ != State::kIdle) time_out(now, out);
  return finished(std::move(out));
}

void Lms200Session::time_out(Timestamp now, Lms200Output& out) {
  if (now < deadline_) return;
  if (repeats_after_nak_) {
    --tries_;  // what was not understood has not been tried
    send_step(now, out);
  } else if (state_ == State::kStreaming) {
    search_began_ = now;
    begin_watch(now, out);
  } else if (state_ == State::kWatching) {
    end_visit(now, out);
  } else if (state_ == State::kStopping) {
    out.output.requests.push_back({PortRequest::Kind::kDiscardInput, {}, 0});
    begin_step(State::kProbing, now, out);
  } else if (state_ == State::kSettling) {
    begin_step(State::kProbing, now, out);
  } else if (tries_ < step_of(state_).tries) {
    send_step(now, out);
  } else {
    give_up_step(now, out);
  }
}

void Lms200Session::give_up_step(Timestamp now, Lms200Output& out) {
  switch (state_) {
    case State::kProbing:
      next_baud(now, out);
      break;
    case State::kSettingBaud:  // it may have changed and its answer got lost: look everywhere, then stay there
      may_change_baud_ = false;
      search_from(params_.baud);
      try_baud(now, out);
      break;
    case State::kWritingConfiguration:
      begin_step(State::kVerifyingConfiguration, now, out);
      break;
    case State::kEnteringInstallation:
      out.output.log.push_back("laser does not open its configuration: kept as it is");
      begin_step(State::kStarting, now, out);
      break;
    default:
      fail("laser has stopped answering while being set up", out);
  }
}

void Lms200Session::answer(const Telegram& telegram, Timestamp now, Lms200Output& out) {
  if (telegram.kind == Telegram::Kind::kAck) return;
  if (telegram.kind == Telegram::Kind::kNak) {
    answer_nak(now);
  } else if (telegram.command == response::kPowerOn) {
    // It is at this baud and silent, with all that was volatile forgotten.
    search_from(baud());
    search_began_ = now;
    may_change_baud_ = true;
    may_change_variant_ = true;
    begin_step(State::kProbing, now, out);
  } else {
    it_speaks_ = true;
    answer_step(telegram, now, out);
  }
}

/// What the laser could not read is sent again (B1), more often than what it does not answer: it is there.
void Lms200Session::answer_nak(Timestamp now) {
  const bool has_asked = state_ != State::kStreaming && !step_of(state_).request.empty();
  if (!has_asked) return;
  repeats_after_nak_ = ++naks_ <= kMaxNaks;
  deadline_ = std::min(deadline_, now + duration_from_seconds(kPauseAfterNakS));
}

void Lms200Session::answer_step(const Telegram& telegram, Timestamp now, Lms200Output& out) {
  const bool refused = telegram.command == response::kRefused;
  switch (state_) {
    case State::kProbing:
      answer_probe(telegram, now, out);
      break;
    case State::kSettingBaud:
      answer_baud_change(telegram, now, out);
      break;
    case State::kSettingVariant:
      if (refused || telegram.command == response::kVariant) finish_variant(now, out);
      break;
    case State::kReadingConfiguration:
    case State::kVerifyingConfiguration:
      if (telegram.command == response::kConfiguration) compare_configuration(now, out);
      break;
    case State::kEnteringInstallation:
      if (mode_was_switched(telegram) == true) {
        ++writes_;
        out.output.log.push_back("laser configuration is being written");
        begin_step(State::kWritingConfiguration, now, out);
      } else if (refused || mode_was_switched(telegram) == false) {
        give_up_step(now, out);
      }
      break;
    case State::kWritingConfiguration:
      if (refused || telegram.command == response::kConfigurationWritten) {
        begin_step(State::kVerifyingConfiguration, now, out);
      }
      break;
    case State::kStarting:
      if (mode_was_switched(telegram) == true || telegram.command == response::kScan) {
        begin_stream(now, out);
      }
      break;
    case State::kStreaming:
      answer_stream(telegram, now, out);
      break;
    case State::kWatching:
      answer_watch(telegram, now, out);
      break;
    case State::kIdle:
    case State::kStopping:
    case State::kSettling:
      break;
  }
}

void Lms200Session::answer_baud_change(const Telegram& telegram, Timestamp now, Lms200Output& out) {
  const std::optional<bool> switched = mode_was_switched(telegram);
  if (switched == true) {
    out.output.log.push_back("laser line switching baud=" + std::to_string(params_.baud));
    may_change_baud_ = false;  // once is enough: where it does not follow, it stays where it is
    search_from(params_.baud);
    set_baud(params_.baud, out);
    begin_step(State::kSettling, now, out);
  } else if (switched == false || telegram.command == response::kRefused) {
    out.output.log.push_back("laser refuses baud=" + std::to_string(params_.baud) + ": stays at " +
                             std::to_string(baud()));
    may_change_baud_ = false;
    set_up(now, out);
  }
}

void Lms200Session::finish_variant(Timestamp now, Lms200Output& out) {
  if (known_variant_ != params_.variant) {
    out.output.log.push_back("laser refuses variant=" + name_of(params_.variant) + ": keeps " +
                             (known_variant_ ? name_of(*known_variant_) : "its own"));
  }
  may_change_variant_ = false;
  set_up(now, out);
}

void Lms200Session::answer_probe(const Telegram& telegram, Timestamp now, Lms200Output& out) {
  if (telegram.command == response::kStatus && known_variant_) {
    set_up(now, out);
  } else if (telegram.command == response::kScan && ++interruptions_ <= kMaxInterruptions) {
    begin_step(State::kStopping, now, out);  // the baud is right, but it did not hear us
  }
}

/// The next thing that is not yet as wanted.
void Lms200Session::set_up(Timestamp now, Lms200Output& out) {
  if (may_change_baud_ && baud() != params_.baud) {
    begin_step(State::kSettingBaud, now, out);
  } else if (may_change_variant_ && known_variant_ != params_.variant) {
    begin_step(State::kSettingVariant, now, out);
  } else {
    begin_step(State::kReadingConfiguration, now, out);
  }
}

void Lms200Session::compare_configuration(Timestamp now, Lms200Output& out) {
  const Configuration wanted = wanted_configuration();
  const bool is_as_wanted = known_configuration_ == wanted;
  if (!is_as_wanted && writes_ < kMaxWrites) {
    begin_step(State::kEnteringInstallation, now, out);
    return;
  }
  if (!is_as_wanted) out.output.log.push_back("laser does not take its configuration: kept as it is");
  begin_step(State::kStarting, now, out);
}

void Lms200Session::begin_stream(Timestamp now, Lms200Output& out) {
  out.output.log.push_back("laser streams baud=" + std::to_string(baud()) +
                           " variant=" + (known_variant_ ? name_of(*known_variant_) : "?"));
  if (known_mode_ && known_variant_ && known_configuration_) {
    agreement_ = Agreement{*known_mode_, *known_variant_, known_configuration_->units()};
  }
  home_baud_ = baud();
  check_at_.reset();
  last_scan_ = now;
  was_garbage_ = false;
  state_ = State::kStreaming;
  deadline_ = now + patience_with_stream();
}

Lms200Output Lms200Session::close(Timestamp) {
  Lms200Output out;
  if (mode_ == SessionMode::kListenOnly || state_ == State::kIdle) return out;
  write(mode_request(mode::kOnRequest), out);
  state_ = State::kIdle;
  return out;
}

void Lms200Session::fail(std::string reason, Lms200Output& out) {
  state_ = State::kIdle;
  out.output.failed = std::move(reason);
}

void Lms200Session::write(std::vector<std::uint8_t> bytes, Lms200Output& out) {
  out.output.requests.push_back({PortRequest::Kind::kWrite, std::move(bytes), 0});
}

void Lms200Session::set_baud(unsigned baud, Lms200Output& out) {
  decoder_.set_baud(baud);
  out.output.requests.push_back({PortRequest::Kind::kSetBaud, {}, baud});
}

Lms200Output Lms200Session::finished(Lms200Output out) const {
  if (mode_ == SessionMode::kLive && state_ != State::kIdle) out.output.wake_at = deadline_;
  return out;
}

}  // namespace deltamap::drivers::lms200
