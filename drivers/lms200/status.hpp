// SPDX-License-Identifier: Apache-2.0
// The B1h status telegram (protocols.md B5): 152 bytes that tell variant, units, mode, baud and health. It is answered
// in every mode, so that it serves as probe.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "drivers/lms200/telegram.hpp"

namespace deltamap::drivers::lms200 {

/// Offsets of the fields count from the response byte, as in B5.
struct DeviceStatus {
  std::string software_version = "V02.30 ";            ///< 1, seven characters
  std::uint8_t operating_mode = 0x25;                  ///< 8
  std::uint8_t fault = 0;                              ///< 9, 0 = none
  std::uint8_t variant_type = 0;                       ///< 18
  std::array<std::uint16_t, 8> pollution{};            ///< 19
  std::array<std::uint16_t, 4> reference_pollution{};  ///< 35
  std::uint16_t motor_revolutions = 148;               ///< 67, us per 1/90 turn
  std::uint8_t measuring_mode = 0;                     ///< 102
  std::uint16_t scan_angle_deg = 180;                  ///< 107
  std::uint16_t resolution_centideg = 100;             ///< 109
  std::uint8_t restart_mode = 2;                       ///< 111
  std::uint16_t restart_time = 0;                      ///< 112
  std::uint16_t baud_code = 0x8067;                    ///< 116
  std::uint8_t evaluations = 2;                        ///< 118
  std::uint8_t permanent_baud = 0;                     ///< 119
  std::uint8_t address = 0;                            ///< 120
  std::uint8_t field_set = 0;                          ///< 121
  std::uint8_t units = 0;                              ///< 122, 0 cm, 1 mm
  std::uint8_t laser_on = 1;                           ///< 123
  std::string boot_version = "V02.10 ";                ///< 124, seven characters

  friend bool operator==(const DeviceStatus&, const DeviceStatus&) = default;

  /// nullopt for a code that B5 does not list.
  [[nodiscard]] std::optional<unsigned> baud() const;
};

[[nodiscard]] std::optional<std::uint16_t> baud_code(unsigned baud);

[[nodiscard]] std::optional<DeviceStatus> decoded_status(const Telegram& telegram);
/// The whole telegram; fields that B5 lists and we do not keep are zero.
[[nodiscard]] std::vector<std::uint8_t> status_reply(const DeviceStatus& status);

}  // namespace deltamap::drivers::lms200
