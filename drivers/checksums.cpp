// SPDX-License-Identifier: Apache-2.0
#include "drivers/checksums.hpp"

namespace deltamap::drivers {

std::uint16_t lms200_crc(std::span<const std::uint8_t> bytes) {
  unsigned crc = 0;
  unsigned previous = 0;
  for (const std::uint8_t byte : bytes) {
    crc = (crc & 0x8000u) != 0 ? ((crc & 0x7FFFu) << 1) ^ 0x8005u : crc << 1;
    crc ^= previous << 8 | byte;
    previous = byte;
  }
  return static_cast<std::uint16_t>(crc);
}

std::uint16_t pioneer_checksum(std::span<const std::uint8_t> data) {
  unsigned sum = 0;
  std::size_t i = 0;
  for (; i + 1 < data.size(); i += 2) sum = (sum + (static_cast<unsigned>(data[i]) << 8 | data[i + 1])) & 0xFFFFu;
  if (i < data.size()) sum ^= data[i];
  return static_cast<std::uint16_t>(sum);
}

}  // namespace deltamap::drivers
