// SPDX-License-Identifier: Apache-2.0
// FNV-1a (Fowler, Noll, Vo), 64 bits: names content; no protection against malice.
#pragma once

#include <cstdint>
#include <string_view>

namespace deltamap::daemon {

[[nodiscard]] constexpr std::uint64_t fingerprint_of(std::string_view text) {
  std::uint64_t hash = 0xCBF29CE484222325u;
  for (const char c : text) hash = (hash ^ static_cast<unsigned char>(c)) * 0x100000001B3u;
  return hash;
}

}  // namespace deltamap::daemon
