// SPDX-License-Identifier: Apache-2.0
#include "drivers/lms200/stream_watch.hpp"

#include <algorithm>
#include <cmath>

#include "drivers/lms200/command.hpp"

namespace deltamap::drivers::lms200 {
namespace {

constexpr double kPatienceS = 0.5;        // of silence in a stream, then it is asked
constexpr double kPatiencePeriods = 3.0;  // or that many scans, where they come slowly
constexpr double kTimeoutPeriods = 5.0;   // a stream is silent only when so many scans are missing
constexpr double kLongestPauseS = 0.08;   // more than between the telegrams of any stream (B7: up to 53 ms)
constexpr double kPauseOfChecksS = 0.5;   // between requests for the status while scans come
constexpr int kMaxUnanswered = 3;

}  // namespace

StreamWatch::StreamWatch(const Lms200Params& params)
    : scan_timeout_s_{params.scan_timeout_s},
      power_on_wait_s_{params.power_on_wait_s},
      home_baud_{params.baud},
      plan_{params.baud} {}

void StreamWatch::start(Timestamp now) {
  search_began_ = now;
  last_scan_ = now;
  silence_told_ = !agreement_;
  state_ = State::kIdle;
}

void StreamWatch::expect_power_on(Timestamp now) {
  search_began_ = now;
  state_ = State::kIdle;
}

void StreamWatch::begin_stream(Transmitter& line) {
  const Receiver& laser = line.receiver();
  line.log("laser streams baud=" + std::to_string(line.baud()) +
           " variant=" + (laser.variant() ? name_of(*laser.variant()) : "?"));
  if (laser.measuring_mode() && laser.variant() && laser.configuration()) {
    agreement_ = Agreement{*laser.measuring_mode(), *laser.variant(), laser.configuration()->units()};
  }
  home_baud_ = line.baud();
  check_at_.reset();
  state_ = State::kStreaming;
  await_scan(line);
}

void StreamWatch::begin_visits(Transmitter& line) {
  plan_ = VisitPlan{home_baud_, was_garbage_};
  check_at_.reset();
  unanswered_ = 0;
  state_ = State::kVisiting;
  visit(line);
}

Request StreamWatch::status_question(const Receiver& receiver) const {
  const double scan_s = receiver.baud() == home_baud_ ? receiver.nominal_period_s() : 0.0;
  return {status_request(), kStatusTimeoutS + scan_s, 1};
}

void StreamWatch::visit(Transmitter& line) {
  it_speaks_ = false;
  was_garbage_ = false;
  if (plan_.baud() != line.baud()) line.set_baud(plan_.baud());
  pending_.begin(status_question(line.receiver()), line);
  visit_end_ = pending_.deadline();
}

void StreamWatch::hear_nak(Timestamp now) {
  if (state_ == State::kVisiting) pending_.hear_nak(now);
}

void StreamWatch::time_out(Transmitter& line) {
  if (state_ == State::kStreaming) {
    search_began_ = line.now();
    state_ = State::kFellSilent;
  } else if (pending_.may_be_sent_again()) {
    pending_.send_again(status_question(line.receiver()), line);
  } else {
    end_visit(line);
  }
}

void StreamWatch::end_visit(Transmitter& line) {
  if (it_speaks_ && ++unanswered_ >= kMaxUnanswered) {  // it streams and does not hear, or says what nobody asked for
    state_ = State::kDoesNotHear;
    return;
  }
  const double timeout_s = scan_timeout_s(line.receiver());
  const bool is_long = line.now() - last_scan_ >= duration_from_seconds(timeout_s);
  if (is_long && !silence_told_) {
    silence_told_ = true;
    line.log("laser has sent no scan for " + std::to_string(std::lround(timeout_s * 1e3)) + " ms");
  }
  if (line.now() - search_began_ >= duration_from_seconds(power_on_wait_s_)) {
    state_ = State::kGivenUp;
    return;
  }
  if (!it_speaks_) {
    unanswered_ = 0;
    plan_.advance(was_garbage_, is_long);
  }
  visit(line);
}

void StreamWatch::answer(const Telegram& telegram, Transmitter& line) {
  if (state_ == State::kStreaming) {
    answer_stream(telegram, line);
  } else {
    it_speaks_ = true;
    answer_visit(telegram, line);
  }
}

void StreamWatch::answer_visit(const Telegram& telegram, Transmitter& line) {
  if (const std::optional<DeviceStatus> status = decoded_status(telegram)) {
    if (streams_as_agreed(*status, line.baud())) {
      resume(true, line);
    } else {
      state_ = State::kMustBeSetUp;
    }
    return;
  }
  const bool mode_is_known = line.receiver().measuring_mode() && agreement_;
  if (telegram.command == response::kScan && mode_is_known && line.baud() == home_baud_) resume(false, line);
}

bool StreamWatch::streams_as_agreed(const DeviceStatus& status, unsigned baud) const {
  const Agreement told{status.measuring_mode,
                       {status.scan_angle_deg, status.resolution_centideg},
                       status.units == 0 ? Units::kCentimetre : Units::kMillimetre};
  return baud == home_baud_ && status.operating_mode == mode::kStreamAll && agreement_ == told;
}

void StreamWatch::resume(bool is_checked, Transmitter& line) {
  line.log("laser streams again silence_ms=" + std::to_string(std::lround(seconds(line.now() - last_scan_) * 1e3)));
  check_at_.reset();
  if (!is_checked) ask_whether_as_agreed(line);
  state_ = State::kStreaming;
  silence_told_ = false;
  await_scan(line);
}

void StreamWatch::answer_stream(const Telegram& telegram, Transmitter& line) {
  const std::optional<DeviceStatus> status = decoded_status(telegram);
  if (status && check_at_) {
    check_at_.reset();
    if (!streams_as_agreed(*status, line.baud())) state_ = State::kMustBeSetUp;
    return;
  }
  if (telegram.command != response::kScan) return;
  silence_told_ = false;
  await_scan(line);
  if (check_at_ && *check_at_ <= line.now()) ask_whether_as_agreed(line);
}

/// The stream is alive: the next scan is due within the patience with it.
void StreamWatch::await_scan(const Transmitter& line) {
  const Receiver& laser = line.receiver();
  last_scan_ = line.now();
  was_garbage_ = false;
  const double patience_s = std::max(kPatienceS, kPatiencePeriods * laser.nominal_period_s());
  scan_due_ = line.now() + duration_from_seconds(std::min(scan_timeout_s(laser), patience_s));
}

void StreamWatch::ask_whether_as_agreed(Transmitter& line) {
  line.write(status_request());
  check_at_ = line.now() + duration_from_seconds(kPauseOfChecksS);
}

void StreamWatch::take_no_telegram(bool was_garbage, Timestamp now) {
  was_garbage_ = was_garbage_ || was_garbage;
  if (state_ != State::kVisiting || it_speaks_) return;
  const Timestamp soon = now + duration_from_seconds(kLongestPauseS);
  pending_.wait_until(was_garbage ? std::min(visit_end_, soon) : visit_end_);
}

double StreamWatch::scan_timeout_s(const Receiver& receiver) const {
  return std::max(scan_timeout_s_, kTimeoutPeriods * receiver.nominal_period_s());
}

}  // namespace deltamap::drivers::lms200
