// SPDX-License-Identifier: Apache-2.0
// A laser that has fallen silent or does not answer. It is asked for its status in short visits, every other one at the
// baud where it should be, most of the others at 9600, where it is after a power cut (protocols.md B3, B6). A scan at
// the right baud resumes the stream at once; its status is asked for meanwhile. A burst of bytes that make no telegram
// means that somebody speaks at another baud, most likely a laser that has started up: a detour to 9600 follows.
#include <algorithm>
#include <cmath>

#include "drivers/lms200/session.hpp"

namespace deltamap::drivers::lms200 {
namespace {

constexpr unsigned kPowerOnBaud = 9600;
constexpr double kPatienceS = 0.5;        // of silence in a stream, then it is asked
constexpr double kPatiencePeriods = 3.0;  // or that many scans, where they come slowly
constexpr double kTimeoutPeriods = 5.0;   // a stream is silent only when so many scans are missing
constexpr double kLongestPauseS = 0.08;   // more than between the telegrams of any stream (B7: up to 53 ms)
constexpr double kPauseOfChecksS = 0.5;   // between requests for the status while scans come
constexpr int kMaxUnanswered = 3;

}  // namespace

void Lms200Session::begin_watch(Timestamp now, Lms200Output& out) {
  may_change_baud_ = true;
  may_change_variant_ = true;
  search_from(home_baud_);
  if (agreement_) diagnosis_.reset();  // else the first round has heard something
  check_at_.reset();
  unanswered_ = 0;
  visits_ = 0;
  is_detour_ = was_garbage_ && home_baud_ != kPowerOnBaud;
  visit(now, out);
}

unsigned Lms200Session::visited_baud() const {
  if (is_detour_) return kPowerOnBaud;
  if (visits_ % 2 == 0) return home_baud_;
  constexpr unsigned kTurnsOfOthers = 3;  // one of so many is another than the baud after a power cut
  const bool may_have_lost_power = home_baud_ != kPowerOnBaud;
  const unsigned turn = visits_ / 2;
  if (may_have_lost_power && turn % kTurnsOfOthers != kTurnsOfOthers - 1) return kPowerOnBaud;
  const std::size_t other = may_have_lost_power ? turn / kTurnsOfOthers : turn;
  return bauds_[1 + other % (bauds_.size() - 1)];
}

void Lms200Session::visit(Timestamp now, Lms200Output& out) {
  it_speaks_ = false;
  was_garbage_ = false;
  if (visited_baud() != baud()) set_baud(visited_baud(), out);
  begin_step(State::kWatching, now, out);
  visit_end_ = deadline_;
}

void Lms200Session::end_visit(Timestamp now, Lms200Output& out) {
  if (it_speaks_ && ++unanswered_ >= kMaxUnanswered) {  // it streams and does not hear, or says what nobody asked for
    search_from(baud());
    try_baud(now, out);
    return;
  }
  const bool is_long = now - last_scan_ >= duration_from_seconds(scan_timeout_s());
  if (is_long && !silence_told_) {
    silence_told_ = true;
    const auto silence_ms = std::lround(scan_timeout_s() * 1e3);
    out.output.log.push_back("laser has sent no scan for " + std::to_string(silence_ms) + " ms");
  }
  if (now - search_began_ >= duration_from_seconds(params_.power_on_wait_s)) {
    std::string tried;
    for (const unsigned baud : bauds_) tried += (tried.empty() ? "" : ", ") + std::to_string(baud);
    fail("laser does not answer at " + tried + " baud: " + diagnosis_.phrase(), out);
    return;
  }
  if (!it_speaks_) {
    unanswered_ = 0;
    is_detour_ = was_garbage_ && !is_detour_ && baud() != kPowerOnBaud && home_baud_ != kPowerOnBaud;
    if (!is_detour_ && (is_long || was_garbage_ || baud() != home_baud_)) ++visits_;
  }
  visit(now, out);
}

void Lms200Session::answer_watch(const Telegram& telegram, Timestamp now, Lms200Output& out) {
  if (const std::optional<DeviceStatus> status = decoded_status(telegram)) {
    if (streams_as_agreed(*status)) {
      resume(true, now, out);
    } else {
      set_up(now, out);
    }
  } else if (telegram.command == response::kScan && known_mode_ && agreement_ && baud() == home_baud_) {
    resume(false, now, out);
  }
}

bool Lms200Session::streams_as_agreed(const DeviceStatus& status) const {
  const Agreement told{status.measuring_mode,
                       {status.scan_angle_deg, status.resolution_centideg},
                       status.units == 0 ? Units::kCentimetre : Units::kMillimetre};
  return baud() == home_baud_ && status.operating_mode == mode::kStreamAll && agreement_ == told;
}

void Lms200Session::resume(bool is_checked, Timestamp now, Lms200Output& out) {
  out.output.log.push_back("laser streams again silence_ms=" +
                           std::to_string(std::lround(seconds(now - last_scan_) * 1e3)));
  check_at_.reset();
  if (!is_checked) ask_whether_as_agreed(now, out);
  last_scan_ = now;
  was_garbage_ = false;
  silence_told_ = false;
  state_ = State::kStreaming;
  deadline_ = now + patience_with_stream();
}

void Lms200Session::answer_stream(const Telegram& telegram, Timestamp now, Lms200Output& out) {
  const std::optional<DeviceStatus> status = decoded_status(telegram);
  if (status && check_at_) {
    check_at_.reset();
    if (!streams_as_agreed(*status)) set_up(now, out);
    return;
  }
  if (telegram.command != response::kScan) return;
  last_scan_ = now;
  was_garbage_ = false;
  silence_told_ = false;
  deadline_ = now + patience_with_stream();
  if (check_at_ && *check_at_ <= now) ask_whether_as_agreed(now, out);
}

void Lms200Session::ask_whether_as_agreed(Timestamp now, Lms200Output& out) {
  write(status_request(), out);
  check_at_ = now + duration_from_seconds(kPauseOfChecksS);
}

void Lms200Session::take_no_telegram(bool was_garbage, Timestamp now) {
  was_garbage_ = was_garbage_ || was_garbage;
  if (state_ != State::kWatching || it_speaks_) return;
  deadline_ = was_garbage ? std::min(visit_end_, now + duration_from_seconds(kLongestPauseS)) : visit_end_;
}

void Lms200Session::diagnose(std::span<const std::uint8_t> bytes, Lms200Output& out) {
  const bool was_swapped = diagnosis_.is_swapped();
  diagnosis_.hear(bytes);
  if (diagnosis_.is_swapped() && !was_swapped) out.output.log.push_back(diagnosis_.phrase());
}

double Lms200Session::scan_timeout_s() const {
  return std::max(params_.scan_timeout_s, kTimeoutPeriods * nominal_period_s());
}

Duration Lms200Session::patience_with_stream() const {
  return duration_from_seconds(std::min(scan_timeout_s(), std::max(kPatienceS, kPatiencePeriods * nominal_period_s())));
}

}  // namespace deltamap::drivers::lms200
