// SPDX-License-Identifier: Apache-2.0
#include "drivers/lms200/stream_setup.hpp"

#include "drivers/lms200/baud_search.hpp"
#include "drivers/lms200/command.hpp"

namespace deltamap::drivers::lms200 {
namespace {

constexpr double kStopPauseS = 0.1;     // B8: then what was on the line is through
constexpr double kSettlePauseS = 0.45;  // B3: 75 to 434 ms until usable at a new baud
constexpr double kAckTimeoutS = 0.2;    // B1: it comes within 60 ms; an adapter may hold it back
constexpr int kMaxInterruptions = 10;
constexpr int kMaxWrites = 2;  // the EEPROM stands some thousands

}  // namespace

void StreamSetup::search(unsigned first_baud, Transmitter& line) {
  may_change_baud_ = true;
  may_change_variant_ = true;
  search_from(first_baud);
  try_baud(line);
}

void StreamSetup::set_up_started(Transmitter& line) {
  may_change_baud_ = true;
  may_change_variant_ = true;
  search_from(line.baud());
  begin_step(State::kProbing, line);
}

void StreamSetup::set_up_known(Transmitter& line) {
  may_change_baud_ = true;
  may_change_variant_ = true;
  take_next_step(line);
}

void StreamSetup::search_from(unsigned first_baud) {
  bauds_ = baud_search(first_baud);
  attempt_ = 0;
}

Request StreamSetup::request_of(State state, const Receiver& receiver) const {
  switch (state) {
    case State::kStopping:
      return {mode_request(mode::kOnRequest), kStopPauseS, 1};
    case State::kProbing:
      return {status_request(), kStatusTimeoutS, 3};
    case State::kSettingBaud:
      return {baud_request(params_.baud), 1.0, 3};
    case State::kSettling:
      return {{}, kSettlePauseS, 1};
    case State::kSettingVariant:
      return {variant_request(params_.variant), 1.5, 4, kAckTimeoutS};
    case State::kReadingConfiguration:
    case State::kVerifyingConfiguration:
      return {configuration_request(), 1.0, 4, kAckTimeoutS};
    case State::kEnteringInstallation:
      return {installation_request(), 3.0, 3};
    case State::kWritingConfiguration:
      return {write_configuration_request(receiver.wanted_configuration()), 15.0, 1};  // what came of it is read
    case State::kStarting:
      return {mode_request(mode::kStreamAll), 1.0, 4, kAckTimeoutS};
  }
  return {};
}

void StreamSetup::begin_step(State state, Transmitter& line) {
  state_ = state;
  result_ = Result::kPending;
  pending_.begin(request_of(state, line.receiver()), line);
}

void StreamSetup::try_baud(Transmitter& line) {
  interruptions_ = 0;
  line.set_baud(bauds_[attempt_]);
  begin_step(State::kStopping, line);
}

void StreamSetup::try_next_baud(Transmitter& line) {
  if (++attempt_ < bauds_.size()) {
    try_baud(line);
  } else {
    result_ = Result::kNobodyAnswers;
  }
}

void StreamSetup::time_out(Transmitter& line) {
  if (pending_.may_be_sent_again()) {
    pending_.send_again(request_of(state_, line.receiver()), line);
  } else {
    give_up_step(line);
  }
}

void StreamSetup::give_up_step(Transmitter& line) {
  switch (state_) {
    case State::kStopping:
      line.discard_input();
      begin_step(State::kProbing, line);
      break;
    case State::kSettling:
      begin_step(State::kProbing, line);
      break;
    case State::kProbing:
      try_next_baud(line);
      break;
    case State::kSettingBaud:  // it may have changed and its answer got lost: look everywhere, then stay there
      may_change_baud_ = false;
      search_from(params_.baud);
      try_baud(line);
      break;
    case State::kWritingConfiguration:
      begin_step(State::kVerifyingConfiguration, line);
      break;
    case State::kEnteringInstallation:
      line.log("laser does not open its configuration: kept as it is");
      begin_step(State::kStarting, line);
      break;
    default:
      result_ = Result::kStoppedAnswering;
  }
}

void StreamSetup::answer(const Telegram& telegram, Transmitter& line) {
  switch (state_) {
    case State::kProbing:
      return answer_probe(telegram, line);
    case State::kSettingBaud:
      return answer_baud_change(telegram, line);
    case State::kSettingVariant:
      return answer_variant(telegram, line);
    case State::kReadingConfiguration:
    case State::kVerifyingConfiguration:
      if (telegram.command == response::kConfiguration) compare_configuration(line);
      return;
    case State::kEnteringInstallation:
      return answer_password(telegram, line);
    case State::kWritingConfiguration:
      if (telegram.command == response::kRefused || telegram.command == response::kConfigurationWritten) {
        begin_step(State::kVerifyingConfiguration, line);
      }
      return;
    case State::kStarting:
      if (mode_was_switched(telegram) == true || telegram.command == response::kScan) result_ = Result::kStreams;
      return;
    case State::kStopping:
    case State::kSettling:
      return;
  }
}

void StreamSetup::answer_probe(const Telegram& telegram, Transmitter& line) {
  if (telegram.command == response::kStatus && line.receiver().variant()) {
    take_next_step(line);
  } else if (telegram.command == response::kScan && ++interruptions_ <= kMaxInterruptions) {
    begin_step(State::kStopping, line);  // the baud is right, but it did not hear us
  }
}

void StreamSetup::answer_baud_change(const Telegram& telegram, Transmitter& line) {
  const std::optional<bool> switched = mode_was_switched(telegram);
  if (switched == true) {
    line.log("laser line switching baud=" + std::to_string(params_.baud));
    may_change_baud_ = false;  // once is enough: where it does not follow, it stays where it is
    search_from(params_.baud);
    line.set_baud(params_.baud);
    begin_step(State::kSettling, line);
  } else if (switched == false || telegram.command == response::kRefused) {
    line.log("laser refuses baud=" + std::to_string(params_.baud) + ": stays at " + std::to_string(line.baud()));
    may_change_baud_ = false;
    take_next_step(line);
  }
}

void StreamSetup::answer_variant(const Telegram& telegram, Transmitter& line) {
  if (telegram.command != response::kRefused && telegram.command != response::kVariant) return;
  const std::optional<ScanVariant>& active = line.receiver().variant();
  if (active != params_.variant) {
    line.log("laser refuses variant=" + name_of(params_.variant) + ": keeps " +
             (active ? name_of(*active) : "its own"));
  }
  may_change_variant_ = false;
  take_next_step(line);
}

void StreamSetup::answer_password(const Telegram& telegram, Transmitter& line) {
  const std::optional<bool> opened = mode_was_switched(telegram);
  if (opened == true) {
    ++writes_;
    line.log("laser configuration is being written");
    begin_step(State::kWritingConfiguration, line);
  } else if (opened == false || telegram.command == response::kRefused) {
    give_up_step(line);
  }
}

/// To the next thing that is not yet as wanted.
void StreamSetup::take_next_step(Transmitter& line) {
  if (may_change_baud_ && line.baud() != params_.baud) {
    begin_step(State::kSettingBaud, line);
  } else if (may_change_variant_ && line.receiver().variant() != params_.variant) {
    begin_step(State::kSettingVariant, line);
  } else {
    begin_step(State::kReadingConfiguration, line);
  }
}

void StreamSetup::compare_configuration(Transmitter& line) {
  const bool is_as_wanted = line.receiver().configuration() == line.receiver().wanted_configuration();
  if (!is_as_wanted && writes_ < kMaxWrites) return begin_step(State::kEnteringInstallation, line);
  if (!is_as_wanted) line.log("laser does not take its configuration: kept as it is");
  begin_step(State::kStarting, line);
}

}  // namespace deltamap::drivers::lms200
