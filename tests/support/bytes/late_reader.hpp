// SPDX-License-Identifier: Apache-2.0
// A serial line in virtual time: bytes arrive one after another at its rate, and a reader that may be late takes what
// waits, in one piece or in several right after each other.
#pragma once

#include <limits>
#include <utility>
#include <vector>

#include "drivers/received_bytes.hpp"
#include "tests/support/bytes/conversation.hpp"

namespace deltamap::tests {

class LateReader {
 public:
  explicit LateReader(unsigned baud) : baud_{baud} {}

  /// Puts a frame on the line, behind what is there; returns when its first byte arrives.
  Timestamp send(const std::vector<std::uint8_t>& frame, Timestamp begin) {
    const Timestamp first = std::max(begin, free_);
    for (std::size_t i = 0; i < frame.size(); ++i) waiting_.push_back({first + drivers::line_time(i, baud_), frame[i]});
    free_ = first + drivers::line_time(frame.size(), baud_);
    return first;
  }

  /// What has arrived by then, in pieces of at most `most` bytes that are read 20 µs after one another, and after all
  /// that were read before.
  [[nodiscard]] std::vector<SentBytes> read(Timestamp at, std::size_t most = std::numeric_limits<std::size_t>::max()) {
    std::vector<SentBytes> pieces;
    std::size_t taken = 0;
    for (; taken < waiting_.size() && waiting_[taken].at <= at; ++taken) {
      if (pieces.empty() || pieces.back().bytes.size() == most) {
        last_read_ = std::max(pieces.empty() ? at : last_read_, last_read_ + std::chrono::microseconds{20});
        pieces.push_back({last_read_, {}});
      }
      pieces.back().bytes.push_back(waiting_[taken].value);
    }
    waiting_.erase(waiting_.begin(), waiting_.begin() + static_cast<std::ptrdiff_t>(taken));
    return pieces;
  }

 private:
  struct Arrival {
    Timestamp at;
    std::uint8_t value = 0;
  };
  unsigned baud_;
  Timestamp free_{};
  Timestamp last_read_{};
  std::vector<Arrival> waiting_;
};

}  // namespace deltamap::tests
