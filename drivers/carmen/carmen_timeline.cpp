// SPDX-License-Identifier: Apache-2.0
#include "drivers/carmen/carmen_timeline.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "core/counted.hpp"

namespace deltamap::drivers::carmen {
namespace {

constexpr Duration kCrossed = std::chrono::seconds(1);        // messages that overtook each other are less apart
constexpr Duration kLongestPause = std::chrono::seconds(10);  // after which a clock may have been set on again
constexpr Duration kLeastForward = std::chrono::seconds(60);  // a step that a pause is not mistaken for
constexpr Duration kLongPause = std::chrono::hours(1);        // carmen_bytes.cpp fills no longer one
constexpr double kSteady_s = 10.0;                            // the logger's times beside the stamps
constexpr double kSteadyShare = 0.1;
constexpr Duration kUsualStep = std::chrono::milliseconds(100);

std::string text_of(double value) {
  char text[32];
  (void)std::snprintf(text, sizeof text, "%.3g", value);
  return text;
}

}  // namespace

/// By the logger's own clock, which runs on when the computer's is set; 0 where it says nothing of another sweep.
Duration CarmenTimeline::since(const LastScan& last, const CarmenTimes& times, const ScanKind& scan) {
  if (last.kind != scan.name || !last.logger || !times.logger || *times.logger - *last.logger > kCrossed)
    return Duration{0};
  return std::max(Duration{0}, *times.logger - *last.logger);
}

std::optional<Duration> CarmenTimeline::passed_by_logger(const CarmenTimes& times) const {
  if (!last_logger_ || !times.logger || *times.logger <= *last_logger_) return std::nullopt;
  return *times.logger - *last_logger_;
}

/// Logs that were played again, faster, have a logger's time that tells nothing of a pause.
bool CarmenTimeline::has_steady_logger() const {
  if (!began_ || !last_logger_) return false;
  const double by_stamps_s = seconds(*newest_ - began_->first);
  const double by_logger_s = seconds(*last_logger_ - began_->second);
  return std::abs(by_stamps_s - by_logger_s) <= std::max(kSteady_s, kSteadyShare * by_stamps_s);
}

void CarmenTimeline::take_steps_out(Timestamp told, const CarmenTimes& times, std::size_t line) {
  const Duration ahead = told + shift_ - *newest_;
  const bool is_back = ahead < -kCrossed;
  if (!is_back && ahead <= kLongestPause) return;
  const Duration as_before = told + shift_before_ - *newest_;
  if (as_before > -kCrossed && as_before < kLongestPause) {  // a single stamp was wrong, or the clock was set again
    std::swap(shift_, shift_before_);
    return;
  }
  const auto passed = passed_by_logger(times);
  const bool runs_on = passed && *passed < kLongestPause;
  const bool is_forward = ahead > kLeastForward && runs_on && has_steady_logger();
  if (is_back || is_forward) {
    shift_before_ = shift_;
    shift_ = *newest_ + (runs_on ? *passed : kUsualStep) - told;
    is_back ? set_back_.add(line, -ahead) : set_forward_.add(line, ahead);
  } else if (ahead > kLongPause && !(passed && *passed > kLongPause)) {
    stepped_on_.add(line, ahead);
  }
}

CarmenTimeline::Placed CarmenTimeline::place(Timestamp told, const CarmenTimes& times,
                                             const std::optional<ScanKind>& scan, std::size_t line) {
  if (newest_) take_steps_out(told, times, line);
  Placed placed{told + shift_};
  if (scan) {
    std::optional<LastScan>& last = last_scans_[scan->has_poses ? 1 : 0];
    if (last && placed.time <= last->time) {
      const Duration apart = since(*last, times, *scan);
      placed.is_repeated = apart <= Duration{0};
      if (!placed.is_repeated) placed.time = last->time + apart;
      (placed.is_repeated ? repeated_ : set_apart_).add(line);
    }
    if (!placed.is_repeated) last = LastScan{placed.time, times.logger, std::string(scan->name)};
  }
  newest_ = newest_ ? std::max(*newest_, placed.time) : placed.time;
  if (times.logger && !began_) began_ = {placed.time, *times.logger};
  if (times.logger) last_logger_ = times.logger;
  return placed;
}

std::string CarmenTimeline::Seen::words() const {
  return counted(count, "time") + " (the first in line " + std::to_string(first_line) + "), by up to " +
         text_of(seconds(farthest)) + " s";
}

std::vector<std::string> CarmenTimeline::clock_notes() const {
  std::vector<std::string> notes;
  for (const auto& [seen, way] : {std::pair{&set_back_, "back"}, {&set_forward_, "forward"}}) {
    if (seen->count > 0)
      notes.push_back("the log's clock was set " + std::string(way) + " " + seen->words() + ": times go on from there");
  }
  if (stepped_on_.count > 0)
    notes.push_back("the log's times step on " + stepped_on_.words() +
                    ": pauses, or a clock that was set? They are kept");
  return notes;
}

std::vector<std::string> CarmenTimeline::repeat_notes() const {
  std::vector<std::string> notes;
  for (const auto& [seen, done] :
       {std::pair{&set_apart_, "set apart by the logger's times"}, {&repeated_, "left out"}}) {
    if (seen->count == 0) continue;
    notes.push_back(counted(seen->count, "scan repeats", "scans repeat") +
                    " the time stamp of the scan before (the first in line " + std::to_string(seen->first_line) +
                    "): " + done);
  }
  return notes;
}

}  // namespace deltamap::drivers::carmen
