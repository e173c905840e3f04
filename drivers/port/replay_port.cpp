// SPDX-License-Identifier: Apache-2.0
#include "drivers/port/replay_port.hpp"

#include <utility>

namespace deltamap::drivers::port {

std::optional<ReplayedRecord> ReplayPort::next() {
  while (auto record = reader_.next()) {
    if (!began_) began_ = record->stamp;
    const double after_s = seconds(record->stamp - *began_);
    if (after_s > window_.to_s) return std::nullopt;
    const bool went_out = !record->bytes.empty() && record->direction == Direction::kOut;
    // Stamps that step back behind the first one are within a window that leaves nothing out.
    const bool in_window = window_.from_s <= 0.0 || after_s >= window_.from_s;
    if (!went_out) return ReplayedRecord{std::move(*record), in_window};
  }
  return std::nullopt;
}

}  // namespace deltamap::drivers::port
