// SPDX-License-Identifier: Apache-2.0
// FNV-1a (Fowler, Noll, Vo), 64 bits: names content; no protection against malice.
#pragma once

#include <cinttypes>
#include <cstdint>
#include <cstdio>
#include <string>
#include <string_view>

namespace deltamap::daemon {

/// `hash`: of what stands before it, for a text that comes in pieces.
[[nodiscard]] constexpr std::uint64_t fingerprint_of(std::string_view text, std::uint64_t hash = 0xCBF29CE484222325u) {
  for (const char c : text) hash = (hash ^ static_cast<unsigned char>(c)) * 0x100000001B3u;
  return hash;
}

/// Sixteen hexadecimal digits.
[[nodiscard]] inline std::string hex_of(std::uint64_t fingerprint) {
  char text[17];
  (void)std::snprintf(text, sizeof text, "%016" PRIx64, fingerprint);
  return text;
}

}  // namespace deltamap::daemon
