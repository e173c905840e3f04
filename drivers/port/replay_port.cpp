// SPDX-License-Identifier: Apache-2.0
#include "drivers/port/replay_port.hpp"

#include <algorithm>
#include <utility>

namespace deltamap::drivers::port {
namespace {

// The window counts what has passed: a clock that was set back, by so much at least, does not begin it anew. Less is
// two ports out of order.
constexpr double kSetBackS = 1.0;

}  // namespace

std::optional<ReplayedRecord> ReplayPort::next() {
  while (auto record = reader_.next()) {
    if (!began_) began_ = last_ = record->stamp;
    if (seconds(last_ - record->stamp) > kSetBackS) began_ = *began_ - (last_ - record->stamp);
    last_ = record->stamp;
    const double after_s = std::max(0.0, seconds(record->stamp - *began_));
    if (after_s > window_.to_s) return std::nullopt;
    const bool went_out = !record->bytes.empty() && record->direction == Direction::kOut;
    if (!went_out) return ReplayedRecord{std::move(*record), after_s >= window_.from_s};
  }
  return std::nullopt;
}

}  // namespace deltamap::drivers::port
