// SPDX-License-Identifier: Apache-2.0
// How each device's frames are checked: for its own codec, and for telling what speaks on a line (line_diagnosis).
#pragma once

#include <cstdint>
#include <span>

namespace deltamap::drivers {

/// The LMS200's, over everything from STX to the byte before the CRC (protocols.md B2).
[[nodiscard]] std::uint16_t lms200_crc(std::span<const std::uint8_t> bytes);

/// The Pioneer's, over the data bytes (protocols.md A2).
[[nodiscard]] std::uint16_t pioneer_checksum(std::span<const std::uint8_t> data);

}  // namespace deltamap::drivers
