// SPDX-License-Identifier: Apache-2.0
#include "drivers/received_bytes.hpp"

#include <algorithm>
#include <cassert>

namespace deltamap::drivers {

Duration line_time(std::size_t bytes, unsigned baud) {
  assert(baud > 0 && "a line has a speed");
  constexpr std::int64_t kBitsPerByte = 10;
  constexpr std::int64_t kNsPerSecond = 1'000'000'000;
  return Duration{static_cast<std::int64_t>(bytes) * kBitsPerByte * kNsPerSecond / static_cast<std::int64_t>(baud)};
}

void ReceivedBytes::append(std::span<const std::uint8_t> bytes, Timestamp stamp) {
  if (begin_ > 0) {  // what is left is less than a frame: moving it is cheap
    bytes_.erase(bytes_.begin(), bytes_.begin() + static_cast<std::ptrdiff_t>(begin_));
    for (Chunk& chunk : chunks_) chunk.end -= begin_;
    begin_ = 0;
  }
  bytes_.insert(bytes_.end(), bytes.begin(), bytes.end());
  chunks_.push_back({bytes_.size(), stamp});
  newest_stamp_ = stamp;
}

void ReceivedBytes::drop_front(std::size_t count) {
  begin_ += count;
  assert(begin_ <= bytes_.size() && "cannot drop what has not come");
  const auto first_kept = std::find_if(chunks_.begin(), chunks_.end(), [&](const Chunk& c) { return c.end > begin_; });
  chunks_.erase(chunks_.begin(), first_kept);
}

void ReceivedBytes::clear() {
  bytes_.clear();
  chunks_.clear();
  begin_ = 0;
}

Timestamp ReceivedBytes::arrival_of_first(std::size_t index, unsigned baud) const {
  const std::size_t absolute = begin_ + index;
  Timestamp earliest = Timestamp::max();
  for (const Chunk& chunk : chunks_) {
    if (chunk.end <= absolute) continue;
    earliest = std::min(earliest, chunk.stamp - line_time(chunk.end - 1 - absolute, baud));
  }
  return earliest;
}

Timestamp ReceivedBytes::stamp_of(std::size_t index) const {
  const std::size_t absolute = begin_ + index;
  const auto chunk = std::find_if(chunks_.begin(), chunks_.end(), [&](const Chunk& c) { return c.end > absolute; });
  assert(chunk != chunks_.end() && "the byte must have come");
  return chunk->stamp;
}

}  // namespace deltamap::drivers
