// SPDX-License-Identifier: Apache-2.0
#include "drivers/lms200/pending_request.hpp"

#include <algorithm>
#include <utility>

namespace deltamap::drivers::lms200 {
namespace {

constexpr double kPauseAfterNakS = 0.04;  // B1: at least 30 ms
constexpr int kMaxNaks = 10;

}  // namespace

void PendingRequest::begin(Request request, Transmitter& line) {
  *this = {};
  send_again(std::move(request), line);
}

void PendingRequest::send_again(Request request, Transmitter& line) {
  if (!repeats_after_nak_) ++tries_;  // what was not understood has not been tried
  repeats_after_nak_ = false;
  most_tries_ = request.tries;
  is_question_ = !request.bytes.empty();
  const Duration on_the_line = line_time(request.bytes.size(), line.baud());
  answer_due_ = line.now() + on_the_line + duration_from_seconds(request.timeout_s);
  const bool awaits_ack = request.ack_timeout_s > 0.0 && request.ack_timeout_s < request.timeout_s;
  deadline_ = awaits_ack ? line.now() + on_the_line + duration_from_seconds(request.ack_timeout_s) : answer_due_;
  if (is_question_) line.write(std::move(request.bytes));
}

void PendingRequest::hear_nak(Timestamp now) {
  if (!is_question_) return;
  repeats_after_nak_ = ++naks_ <= kMaxNaks;
  deadline_ = std::min(deadline_, now + duration_from_seconds(kPauseAfterNakS));
}

}  // namespace deltamap::drivers::lms200
