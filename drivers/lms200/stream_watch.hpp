// SPDX-License-Identifier: Apache-2.0
// The stream, and a laser that has fallen silent or does not answer. It is then asked for its status in short visits,
// every other one at the baud where it should be (VisitPlan; protocols.md B3, B6). A scan at the right baud resumes the
// stream at once; whether the laser still streams as agreed is asked meanwhile.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "drivers/lms200/baud_search.hpp"
#include "drivers/lms200/pending_request.hpp"
#include "drivers/lms200/status.hpp"
#include "drivers/lms200/transmitter.hpp"

namespace deltamap::drivers::lms200 {

class StreamWatch {
 public:
  explicit StreamWatch(const Lms200Params& params);

  // How it begins.
  /// The port is open anew: from here the patience with a silent laser counts.
  void start(Timestamp now);
  /// The laser has just started up and is to be set up: the patience counts from here.
  void expect_power_on(Timestamp now);
  /// The laser has been set up.
  void begin_stream(Transmitter& line);
  void begin_visits(Transmitter& line);

  // What happens.
  /// A telegram that the receiver has taken.
  void answer(const Telegram& telegram, Transmitter& line);
  void hear_nak(Timestamp now);
  /// Whatever else is going on: a chunk has brought no telegram.
  void take_no_telegram(bool was_garbage, Timestamp now);
  /// Called at the deadline.
  void time_out(Transmitter& line);
  [[nodiscard]] Timestamp deadline() const { return state_ == State::kStreaming ? scan_due_ : pending_.deadline(); }

  // What came of it.
  enum class State {
    kIdle,
    kStreaming,
    kVisiting,
    kFellSilent,   // while streaming
    kMustBeSetUp,  // it has told its status, and does not stream as agreed
    kDoesNotHear,  // it speaks at this baud, but does not tell its status
    kGivenUp
  };
  [[nodiscard]] State state() const { return state_; }
  /// It has streamed before.
  [[nodiscard]] bool has_agreement() const { return agreement_.has_value(); }
  /// "38400, 9600, 500000, 19200"
  [[nodiscard]] std::string visited_bauds() const { return plan_.names(); }

 private:
  /// What a stream depends on and a power cut may change.
  struct Agreement {
    std::uint8_t measuring_mode = 0;
    ScanVariant variant;
    Units units = Units::kCentimetre;
    friend bool operator==(const Agreement&, const Agreement&) = default;
  };

  void visit(Transmitter& line);
  void end_visit(Transmitter& line);
  void answer_visit(const Telegram& telegram, Transmitter& line);
  void answer_stream(const Telegram& telegram, Transmitter& line);
  void resume(bool is_checked, Transmitter& line);
  void await_scan(const Transmitter& line);
  void ask_whether_as_agreed(Transmitter& line);
  [[nodiscard]] Request status_question(const Receiver& receiver) const;
  [[nodiscard]] bool streams_as_agreed(const DeviceStatus& status, unsigned baud) const;
  [[nodiscard]] double scan_timeout_s(const Receiver& receiver) const;

  double scan_timeout_s_;
  double power_on_wait_s_;
  State state_ = State::kIdle;
  std::optional<Agreement> agreement_;  // of the last stream
  unsigned home_baud_;                  // where the laser should be found
  std::optional<Timestamp> check_at_;   // streaming again: when to ask again whether as agreed
  Timestamp last_scan_;
  Timestamp scan_due_;
  bool silence_told_ = false;  // in the log
  bool was_garbage_ = false;   // since the last scan or visit: bytes that make no telegram

  VisitPlan plan_;
  PendingRequest pending_;  // of this visit
  Timestamp visit_end_;
  bool it_speaks_ = false;  // a telegram came during this visit
  int unanswered_ = 0;      // visits to a laser that speaks but does not tell its status
  Timestamp search_began_;
};

}  // namespace deltamap::drivers::lms200
