// SPDX-License-Identifier: Apache-2.0
#include "drivers/carmen/carmen_timeline.hpp"

#include <algorithm>
#include <cstdio>

#include "core/counted.hpp"

namespace deltamap::drivers::carmen {
namespace {

constexpr Duration kCrossed = std::chrono::seconds(1);        // messages that overtook each other are less apart
constexpr Duration kLongestPause = std::chrono::seconds(10);  // after which a clock may have been set on again
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

void CarmenTimeline::take_steps_out(Timestamp told, const CarmenTimes& times, std::size_t line) {
  const Duration ahead = told + shift_ - *newest_;
  const Duration as_before = told + shift_before_ - *newest_;
  if (ahead > kLongestPause && as_before > Duration{0} && as_before < kLongestPause) {
    std::swap(shift_, shift_before_);  // a single stamp was wrong, or the clock was set on again
  } else if (ahead < -kCrossed) {
    const bool runs_on =
        last_logger_ && times.logger && *times.logger > *last_logger_ && *times.logger - *last_logger_ < kLongestPause;
    shift_before_ = shift_;
    shift_ = *newest_ + (runs_on ? *times.logger - *last_logger_ : kUsualStep) - told;
    set_back_.add(line);
    farthest_back_ = std::max(farthest_back_, -ahead);
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
  if (times.logger) last_logger_ = times.logger;
  return placed;
}

std::vector<std::string> CarmenTimeline::notes() const {
  std::vector<std::string> notes;
  const auto from = [](const Seen& seen) { return " (the first in line " + std::to_string(seen.first_line) + ")"; };
  if (set_back_.count > 0) {
    notes.push_back("the log's clock was set back " + counted(set_back_.count, "time") + from(set_back_) +
                    ", by up to " + text_of(seconds(farthest_back_)) + " s: times go on from there");
  }
  if (set_apart_.count > 0) {
    notes.push_back(counted(set_apart_.count, "scan repeats", "scans repeat") + " the time stamp of the scan before" +
                    from(set_apart_) + ": set apart by the logger's times");
  }
  if (repeated_.count > 0) {
    notes.push_back(counted(repeated_.count, "scan repeats", "scans repeat") + " the time stamp of the scan before" +
                    from(repeated_) + ": left out");
  }
  return notes;
}

}  // namespace deltamap::drivers::carmen
