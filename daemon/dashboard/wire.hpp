// SPDX-License-Identifier: Apache-2.0
// Numbers of binary messages, little-endian whatever the machine.
#pragma once

#include <bit>
#include <cstddef>
#include <cstdint>
#include <string>
#include <type_traits>

namespace deltamap::daemon::dashboard {

enum class MessageKind : std::uint8_t { kCells = 1, kSamples = 2, kScan = 3, kParticles = 4, kStored = 5 };

template <typename Integer>
void append_number(std::string& bytes, Integer number) requires std::is_integral_v<Integer> {
  auto rest = static_cast<std::make_unsigned_t<Integer>>(number);
  for (std::size_t i = 0; i < sizeof(Integer); ++i) {
    bytes.push_back(static_cast<char>(static_cast<unsigned char>(rest & 0xFFU)));
    if constexpr (sizeof(Integer) > 1) rest = static_cast<std::make_unsigned_t<Integer>>(rest >> 8U);
  }
}
inline void append_number(std::string& bytes, float number) {
  append_number(bytes, std::bit_cast<std::uint32_t>(number));
}
inline void append_number(std::string& bytes, double number) {
  append_number(bytes, std::bit_cast<std::uint64_t>(number));
}

/// The four bytes that every binary message begins with.
inline void append_kind(std::string& bytes, MessageKind kind) {
  append_number(bytes, static_cast<std::uint32_t>(kind));
}

}  // namespace deltamap::daemon::dashboard
