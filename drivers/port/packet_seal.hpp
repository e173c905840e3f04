// SPDX-License-Identifier: Apache-2.0
// Each packet of a recording carries its number and a checksum of what it says, as its epb_packetid: programs that
// edit, cut or join captures keep that option (Wireshark 3.6 and newer), so that a reader sees what they did. Times are
// not sealed: shifting them takes nothing away.
#pragma once

#include <cstdint>
#include <string_view>

#include "drivers/port/byte_record.hpp"

namespace deltamap::drivers::port {

struct PacketSeal {
  std::uint32_t number = 0;  ///< of the packet in its recording, from 0
  std::uint32_t checksum = 0;
};

/// CRC-32 of number, port, direction, bytes and note. The direction of a record without bytes means nothing.
[[nodiscard]] std::uint32_t sealed_checksum(std::uint32_t number, const ByteRecord& record, std::string_view note);

[[nodiscard]] constexpr std::uint64_t packet_id(const PacketSeal& seal) {
  return std::uint64_t{seal.number} << 32 | seal.checksum;
}
[[nodiscard]] constexpr PacketSeal seal_of_id(std::uint64_t id) {
  return {static_cast<std::uint32_t>(id >> 32), static_cast<std::uint32_t>(id)};
}

}  // namespace deltamap::drivers::port
