// SPDX-License-Identifier: Apache-2.0
// What a power cut or a full disk leaves of a recording: its first bytes, and behind them nothing, zeros, ones or
// garbage.
#pragma once

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <string>
#include <vector>

#include "core/random.hpp"

namespace deltamap::test {

/// Cut somewhere behind the first `header` bytes.
inline std::string cut_file(const std::string& whole, std::size_t header, Random& random) {
  constexpr std::uint32_t kLongestTail = 9000;  // some pages
  const auto after = random.index_below(static_cast<std::uint32_t>(whole.size() - header));
  std::string cut = whole.substr(0, header + after);
  const std::uint32_t tail = 1 + random.index_below(kLongestTail);
  switch (random.index_below(4)) {
    case 0:
      return cut;
    case 1:
      return cut.append(tail, '\0');
    case 2:
      return cut.append(tail, '\xFF');
    default:
      for (std::uint32_t i = 0; i < tail; ++i) cut += static_cast<char>(random.index_below(256));
      return cut;
  }
}

/// Where each block of a pcapng file ends.
inline std::vector<std::size_t> block_ends(const std::string& file) {
  std::vector<std::size_t> ends;
  for (std::size_t at = 0; at + 8 <= file.size();) {
    std::uint32_t length = 0;
    std::memcpy(&length, file.data() + at + 4, sizeof length);
    ends.push_back(at += length);
  }
  return ends;
}

/// How many of the blocks are in the damaged file as they were.
inline std::size_t whole_blocks(const std::vector<std::size_t>& ends, const std::string& whole,
                                const std::string& damaged) {
  const auto differ = std::mismatch(whole.begin(), whole.end(), damaged.begin(), damaged.end());
  const auto same = static_cast<std::size_t>(differ.first - whole.begin());
  return static_cast<std::size_t>(std::upper_bound(ends.begin(), ends.end(), same) - ends.begin());
}

}  // namespace deltamap::test
