// SPDX-License-Identifier: Apache-2.0
// The 34 bytes of 74h and 77h (protocols.md B4), and what the measuring mode in them makes of a measured word: which
// bits are range, which are flags, and where the error codes begin.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <string_view>

namespace deltamap::drivers::lms200 {

enum class Units : std::uint8_t { kCentimetre = 0, kMillimetre = 1 };

/// "cm" or "mm".
[[nodiscard]] std::optional<Units> units_named(std::string_view name);

struct Configuration {
  static constexpr std::size_t kSize = 34;
  std::array<std::uint8_t, kSize> bytes{0x00, 0x00, 0x46, 0x00, 0x00, 0x00, 0x01, 0x00, 0x00, 0x02, 0x02, 0x02,
                                        0x00, 0x00, 0x0A, 0x0A, 0x50, 0x64, 0x00, 0x0A, 0x0A, 0x50, 0x80, 0x00,
                                        0x0A, 0x0A, 0x50, 0x64, 0x00, 0x00, 0x00, 0x00, 0x02, 0x00};

  friend bool operator==(const Configuration&, const Configuration&) = default;

  [[nodiscard]] std::uint8_t measuring_mode() const { return bytes[5]; }
  [[nodiscard]] Units units() const { return bytes[6] == 0 ? Units::kCentimetre : Units::kMillimetre; }
  [[nodiscard]] bool sends_real_time_indices() const { return (bytes[4] & 0x02) != 0; }

  void set_measuring_mode(std::uint8_t mode) { bytes[5] = mode; }
  void set_units(Units units) { bytes[6] = static_cast<std::uint8_t>(units); }
};

/// Up to 34 bytes over what was there before: shorter data is legal in 77h. Refused when empty or longer.
[[nodiscard]] std::optional<Configuration> configuration_with(std::span<const std::uint8_t> bytes,
                                                              const Configuration& before);

/// How a measured word reads in one measuring mode.
struct RangeCoding {
  std::uint16_t range_mask = 0x1FFF;
  std::uint16_t beyond_maximum = 0x1FF7;  ///< this and all above, after masking, are codes and no ranges
  friend bool operator==(const RangeCoding&, const RangeCoding&) = default;
};

/// nullopt for modes without ranges (3F) and modes that B4 does not list.
[[nodiscard]] std::optional<RangeCoding> range_coding(std::uint8_t measuring_mode);

}  // namespace deltamap::drivers::lms200
