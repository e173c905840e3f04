// SPDX-License-Identifier: Apache-2.0
#include "drivers/port/packet_seal.hpp"

#include <boost/crc.hpp>

namespace deltamap::drivers::port {

std::uint32_t sealed_checksum(std::uint32_t number, const ByteRecord& record, std::string_view note) {
  const bool went_out = !record.bytes.empty() && record.direction == Direction::kOut;
  boost::crc_32_type crc;
  for (int shift = 0; shift < 32; shift += 8) crc.process_byte(static_cast<std::uint8_t>(number >> shift));
  crc.process_byte(static_cast<std::uint8_t>(record.port));
  crc.process_byte(went_out ? 1 : 0);
  crc.process_bytes(record.bytes.data(), record.bytes.size());
  crc.process_byte('\n');
  crc.process_bytes(note.data(), note.size());
  return crc.checksum();
}

}  // namespace deltamap::drivers::port
