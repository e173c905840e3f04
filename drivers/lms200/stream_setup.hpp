// SPDX-License-Identifier: Apache-2.0
// The way to a stream (protocols.md B8): finds the laser's baud whatever state it is in, brings baud, variant, units
// and mode to what is wanted (writing its EEPROM only where they differ), and starts the stream. A state machine, fed
// with what was received and the time.
#pragma once

#include <cstdint>
#include <vector>

#include "drivers/lms200/params.hpp"
#include "drivers/lms200/pending_request.hpp"
#include "drivers/lms200/transmitter.hpp"

namespace deltamap::drivers::lms200 {

class StreamSetup {
 public:
  explicit StreamSetup(const Lms200Params& params) : params_{params} {}

  // How it begins.
  /// At every baud, this one first.
  void search(unsigned first_baud, Transmitter& line);
  /// At this baud the laser has just started up: it is silent, with all that was volatile forgotten.
  void set_up_started(Transmitter& line);
  /// At this baud the laser has just told its status.
  void set_up_known(Transmitter& line);

  // What happens.
  /// A telegram that the receiver has taken.
  void answer(const Telegram& telegram, Transmitter& line);
  void hear_ack() { pending_.hear_ack(); }
  void hear_nak(Timestamp now) { pending_.hear_nak(now); }
  /// Called at the deadline.
  void time_out(Transmitter& line);
  [[nodiscard]] Timestamp deadline() const { return pending_.deadline(); }

  // What came of it.
  enum class Result {
    kPending,
    kStreams,
    kNobodyAnswers,    // at any baud
    kStoppedAnswering  // while being set up
  };
  [[nodiscard]] Result result() const { return result_; }

 private:
  enum class State {
    kStopping,     // the stream was told to stop at this baud; waiting for silence
    kProbing,      // status requested
    kSettingBaud,  // awaiting the answer at the old speed
    kSettling,     // a moment until the laser is usable at the new one
    kSettingVariant,
    kReadingConfiguration,
    kEnteringInstallation,  // password sent
    kWritingConfiguration,
    kVerifyingConfiguration,
    kStarting  // stream requested
  };

  void answer_probe(const Telegram& telegram, Transmitter& line);
  void answer_baud_change(const Telegram& telegram, Transmitter& line);
  void answer_variant(const Telegram& telegram, Transmitter& line);
  void answer_password(const Telegram& telegram, Transmitter& line);
  void give_up_step(Transmitter& line);
  void begin_step(State state, Transmitter& line);
  [[nodiscard]] Request request_of(State state, const Receiver& receiver) const;
  void search_from(unsigned first_baud);
  void try_baud(Transmitter& line);
  void try_next_baud(Transmitter& line);
  void take_next_step(Transmitter& line);
  void compare_configuration(Transmitter& line);

  Lms200Params params_;
  State state_ = State::kStopping;
  Result result_ = Result::kPending;
  PendingRequest pending_;
  std::vector<unsigned> bauds_;  // in the order of trying
  std::size_t attempt_ = 0;
  int interruptions_ = 0;  // times that a scan came where silence was wanted, at this baud
  int writes_ = 0;         // of the configuration
  bool may_change_baud_ = true;
  bool may_change_variant_ = true;
};

}  // namespace deltamap::drivers::lms200
