// SPDX-License-Identifier: Apache-2.0
// What a line does to a frame: every cut, every flipped bit, and arbitrary streams in arbitrary chunks.
#pragma once

#include <algorithm>
#include <cstdint>
#include <span>
#include <vector>

#include "core/random.hpp"

namespace deltamap::tests {

using Bytes = std::vector<std::uint8_t>;

[[nodiscard]] inline std::vector<Bytes> every_cut(const Bytes& frame) {
  std::vector<Bytes> cuts;
  for (std::size_t size = 1; size < frame.size(); ++size) {
    cuts.emplace_back(frame.begin(), frame.begin() + static_cast<std::ptrdiff_t>(size));  // the tail is missing
    cuts.emplace_back(frame.begin() + static_cast<std::ptrdiff_t>(size), frame.end());    // the head is missing
  }
  for (std::size_t hole = 1; hole + 1 < frame.size(); ++hole) {
    // Losing one byte of a run of equal ones makes the same bytes wherever it was in the run.
    Bytes cut = frame;
    cut.erase(cut.begin() + static_cast<std::ptrdiff_t>(hole));
    cuts.push_back(cut);
  }
  return cuts;
}

[[nodiscard]] inline std::vector<Bytes> every_flipped_bit(const Bytes& frame) {
  std::vector<Bytes> damaged;
  for (std::size_t bit = 0; bit < 8 * frame.size(); ++bit) {
    Bytes flipped = frame;
    flipped[bit / 8] = static_cast<std::uint8_t>(flipped[bit / 8] ^ 1u << bit % 8);
    damaged.push_back(std::move(flipped));
  }
  return damaged;
}

[[nodiscard]] inline Bytes random_bytes(std::size_t count, Random& random) {
  Bytes bytes(count);
  for (std::uint8_t& byte : bytes) byte = static_cast<std::uint8_t>(random.index_below(256));
  return bytes;
}

/// The bytes in chunks of 1 to max_size, one after another.
template <typename Take>
void feed_in_chunks(std::span<const std::uint8_t> bytes, std::uint32_t max_size, Random& random, Take&& take) {
  while (!bytes.empty()) {
    const std::size_t size = std::min<std::size_t>(bytes.size(), 1 + random.index_below(max_size));
    take(bytes.first(size));
    bytes = bytes.subspan(size);
  }
}

}  // namespace deltamap::tests
