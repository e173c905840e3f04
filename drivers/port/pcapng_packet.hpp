// SPDX-License-Identifier: Apache-2.0
// What a section header (draft-ietf-opsawg-pcapng 4.1), an interface description (4.2) and an enhanced packet (4.3)
// say.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "core/time.hpp"
#include "drivers/port/pcapng_block.hpp"

namespace deltamap::drivers::port::pcapng {

/// A section header that names this program as its writer.
[[nodiscard]] bool is_written_by_us(std::span<const std::uint8_t> body);

struct Interface {
  std::string name;
  std::uint16_t link_type = 0;
  unsigned baud = 0;
  std::int64_t ticks_per_s = 1'000'000;  ///< pcapng's default; 0: finer than a Timestamp
  std::int64_t offset_s = 0;
};
/// Throws Damage where the body is too short.
[[nodiscard]] Interface interface_in(std::span<const std::uint8_t> body);

/// Looks into the body that it was read from.
struct Packet {
  std::uint32_t interface = 0;
  std::uint64_t ticks = 0;
  std::span<const std::uint8_t> bytes;
  std::uint32_t bytes_cut_off = 0;  ///< by a snap length
  bool went_out = false;
  bool tells_direction = false;
  std::optional<std::uint64_t> id;
  std::vector<std::string_view> comments;
};
/// Throws Damage where the body is not whole.
[[nodiscard]] Packet packet_in(std::span<const std::uint8_t> body);

/// The time of a packet on its interface, whose ticks must not be finer than a Timestamp. Throws Damage where no
/// Timestamp can hold it.
[[nodiscard]] Timestamp stamp_of(const Packet& packet, const Interface& interface);

}  // namespace deltamap::drivers::port::pcapng
