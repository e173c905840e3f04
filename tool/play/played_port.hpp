// SPDX-License-Identifier: Apache-2.0
// The device's side of one port of a recording, in the order and at the pace in which it came. What a device said after
// it had heard something waits until the client has said as much, for a while: an answer never comes before its
// question.
#pragma once

#include <algorithm>
#include <cstdint>
#include <deque>
#include <optional>
#include <vector>

#include "drivers/port/byte_record.hpp"

namespace deltamap::tool {

class PlayedPort {
 public:
  static constexpr double kPatienceS = 0.5;

  /// Of the recording, in order.
  void add(const drivers::port::ByteRecord& record, double after_s) {
    if (record.bytes.empty()) return;
    if (record.direction == drivers::port::Direction::kOut) {
      recorded_bytes_ += record.bytes.size();
    } else {
      script_.push_back({after_s, recorded_bytes_, record.bytes});
    }
  }
  /// The client has said so many bytes more.
  void hear(std::size_t bytes) { heard_bytes_ += bytes; }

  /// What is due after so many seconds of play.
  [[nodiscard]] std::vector<std::uint8_t> due(double after_s) {
    std::vector<std::uint8_t> bytes;
    while (!script_.empty() && is_due(script_.front(), after_s)) {
      const Chunk& chunk = script_.front();
      // A question that was never asked holds nothing up twice.
      heard_bytes_ = std::max(heard_bytes_, chunk.heard_before);
      bytes.insert(bytes.end(), chunk.bytes.begin(), chunk.bytes.end());
      script_.pop_front();
    }
    return bytes;
  }
  /// When something may be due next; nothing at the end.
  [[nodiscard]] std::optional<double> next_s() const {
    if (script_.empty()) return std::nullopt;
    const Chunk& chunk = script_.front();
    return heard_bytes_ >= chunk.heard_before ? chunk.after_s : chunk.after_s + kPatienceS;
  }

 private:
  struct Chunk {
    double after_s = 0.0;
    std::uint64_t heard_before = 0;  // by the device, bytes
    std::vector<std::uint8_t> bytes;
  };
  [[nodiscard]] bool is_due(const Chunk& chunk, double after_s) const {
    return after_s >= (heard_bytes_ >= chunk.heard_before ? chunk.after_s : chunk.after_s + kPatienceS);
  }

  std::deque<Chunk> script_;
  std::uint64_t recorded_bytes_ = 0;
  std::uint64_t heard_bytes_ = 0;
};

}  // namespace deltamap::tool
