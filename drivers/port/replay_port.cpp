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
    if (!went_out) return ReplayedRecord{std::move(*record), after_s >= window_.from_s};
  }
  return std::nullopt;
}

}  // namespace deltamap::drivers::port
