// SPDX-License-Identifier: Apache-2.0
#include "drivers/port/replay_port.hpp"

#include <algorithm>
#include <cstdio>
#include <utility>

#include "core/counted.hpp"

namespace deltamap::drivers::port {

std::optional<ReplayedRecord> ReplayPort::next() {
  while (!is_over_) {
    auto record = reader_.next();
    if (!record) break;
    const double after_s = passed_.after_s(record->stamp);
    note_clock(after_s);
    is_over_ = after_s > window_.to_s;
    if (is_over_) break;
    packets_before_ += after_s < window_.from_s ? 1 : 0;
    const bool went_out = !record->bytes.empty() && record->direction == Direction::kOut;
    if (!went_out) return ReplayedRecord{std::move(*record), after_s >= window_.from_s};
  }
  return std::nullopt;
}

void ReplayPort::note_clock(double after_s) {
  if (passed_.set_back_s() == 0.0) return;
  if (set_back_++ == 0) first_set_back_s_ = after_s;
  farthest_back_s_ = std::max(farthest_back_s_, passed_.set_back_s());
}

std::uint64_t ReplayPort::count_packets_after() {
  std::uint64_t packets = is_over_ ? 1 : 0;
  while (is_over_ && reader_.next()) ++packets;
  return packets;
}

LogFaults ReplayPort::faults() const {
  LogFaults faults = reader_.faults();
  if (set_back_ == 0) return faults;
  char text[160];
  (void)std::snprintf(text, sizeof text, ", by up to %.3g s (the first %.1f s after its first packet)",
                      farthest_back_s_, first_set_back_s_);
  faults.doubts.push_back(file_.string() + ": its clock was set back " + counted(set_back_, "time") + text +
                          ": times go on from there");
  return faults;
}

}  // namespace deltamap::drivers::port
