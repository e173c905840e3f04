// SPDX-License-Identifier: Apache-2.0
// Bytes that have arrived but are not yet decoded, with the chunks they came in. It answers when a frame's first byte
// arrived: a chunk is stamped when read() returned, so its last byte came no later, and each byte before it one
// character time earlier (docs/frames_and_units.md, protocols.md B7).
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "core/time.hpp"

namespace deltamap::drivers {

/// How long bytes occupy an 8N1 line: 10 bits each.
[[nodiscard]] Duration line_time(std::size_t bytes, unsigned baud);

/// A pause after which an unfinished frame is given up. Devices pause at most 14 ms inside a frame (protocols.md B1).
inline constexpr Duration kLongestPauseInFrame{250'000'000};

class ReceivedBytes {
 public:
  void append(std::span<const std::uint8_t> bytes, Timestamp stamp);
  void drop_front(std::size_t count);
  void clear();

  [[nodiscard]] std::span<const std::uint8_t> bytes() const { return std::span{bytes_}.subspan(begin_); }

  /// The earliest time that the chunks from this byte on allow: the line cannot be faster than its baud rate.
  [[nodiscard]] Timestamp arrival_of_first(std::size_t index, unsigned baud) const;
  /// The stamp of the chunk that holds this byte.
  [[nodiscard]] Timestamp stamp_of(std::size_t index) const;
  /// The stamp of the newest chunk; the epoch where none has come.
  [[nodiscard]] Timestamp newest_stamp() const { return newest_stamp_; }

 private:
  struct Chunk {
    std::size_t end = 0;  // index into bytes_ after its last byte
    Timestamp stamp;
  };

  std::vector<std::uint8_t> bytes_;
  std::size_t begin_ = 0;
  std::vector<Chunk> chunks_;
  Timestamp newest_stamp_;
};

}  // namespace deltamap::drivers
