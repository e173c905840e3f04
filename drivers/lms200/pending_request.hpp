// SPDX-License-Identifier: Apache-2.0
// One request that waits for its answer: when that is overdue, and how often it is asked again (protocols.md B1).
// Requests get lost at certain mirror positions. An ACK is no proof and its loss no failure, but what takes the laser
// long is asked again sooner where no ACK came either. What the laser could not read (NAK) is sent again after a pause,
// more often than what it does not answer: it is there.
#pragma once

#include <algorithm>
#include <cstdint>
#include <vector>

#include "core/time.hpp"
#include "drivers/lms200/transmitter.hpp"

namespace deltamap::drivers::lms200 {

/// Until the answer to status_request(): 160 bytes take 0.25 s at 9600 (B1).
inline constexpr double kStatusTimeoutS = 0.4;

/// What is sent, how long its answer is waited for and how often it is asked.
struct Request {
  std::vector<std::uint8_t> bytes;  ///< empty: a pause
  double timeout_s = 0.0;
  int tries = 1;
  double ack_timeout_s = 0.0;  ///< for so long where no ACK comes; 0: ACKs are not waited for
};

class PendingRequest {
 public:
  void begin(Request request, Transmitter& line);
  void send_again(Request request, Transmitter& line);
  void hear_ack() { deadline_ = std::max(deadline_, answer_due_); }
  void hear_nak(Timestamp now);
  /// Something on the line says that the answer may be awaited until then.
  void wait_until(Timestamp deadline) { deadline_ = deadline; }

  [[nodiscard]] Timestamp deadline() const { return deadline_; }
  /// At the deadline: it is sent again; else it is given up.
  [[nodiscard]] bool may_be_sent_again() const { return repeats_after_nak_ || tries_ < most_tries_; }

 private:
  bool is_question_ = false;
  int most_tries_ = 1;
  int tries_ = 0;
  int naks_ = 0;
  bool repeats_after_nak_ = false;
  Timestamp deadline_;
  Timestamp answer_due_;  // once the laser has said that it was heard
};

}  // namespace deltamap::drivers::lms200
