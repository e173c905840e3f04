// SPDX-License-Identifier: Apache-2.0
// The standard server information packet, SIP (protocols.md A6): what the robot reports every cycle, in its own units.
// From here the odometry takes pose and flags; the simulator encodes the same struct.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace deltamap::drivers::pioneer {

inline constexpr std::uint8_t kSipStopped = 0x32;
inline constexpr std::uint8_t kSipMoving = 0x33;

struct SonarReading {
  std::uint8_t index = 0;  ///< 0 to 31
  std::uint16_t range_mm = 0;
  friend bool operator==(const SonarReading&, const SonarReading&) = default;
};

/// Bits of Sip::flags.
namespace sip_flag {
inline constexpr std::uint16_t kMotorsEnabled = 1u << 0;
inline constexpr std::uint16_t kSonarArrays = 0xFu << 1;
inline constexpr std::uint16_t kStopButton = 1u << 5;
inline constexpr std::uint16_t kEstall = 1u << 6;
inline constexpr std::uint16_t kStopped =
    kStopButton | kEstall;  ///< either: held by a person or by the controller (A9)
inline constexpr std::uint16_t kFarLedge = 1u << 7;
inline constexpr std::uint16_t kNearLedge = 1u << 8;
inline constexpr std::uint16_t kJoystickButton = 1u << 9;
inline constexpr std::uint16_t kChargerPower = 1u << 10;
}  // namespace sip_flag

struct Sip {
  bool moving = false;             ///< type 33 instead of 32
  std::uint16_t x_units = 0;       ///< 15 or 16 significant bits
  std::uint16_t y_units = 0;       ///< 15 or 16 significant bits
  std::int16_t heading_units = 0;  ///< 4096 a turn
  std::int16_t left_mm_per_s = 0;
  std::int16_t right_mm_per_s = 0;
  std::uint8_t battery_decivolts = 0;
  bool left_stall = false;
  bool right_stall = false;
  std::uint8_t rear_bumpers = 0;        ///< bit 0 is segment 1; 7 bits
  std::uint8_t front_bumpers = 0;       ///< bit 0 is segment 1; 7 bits
  std::int16_t control_units = 0;       ///< heading set point
  std::uint16_t flags = 0;              ///< sip_flag
  std::optional<std::uint8_t> compass;  ///< 2 degrees a unit
  std::vector<SonarReading> sonar;      ///< new readings only
  bool sonar_is_cut = false;            ///< the count promised more than came: nothing after it could be read

  // Optional tail, each there only if all before it are.
  std::optional<std::uint8_t> grip_state;
  std::optional<std::uint8_t> analog_port;
  std::optional<std::uint8_t> analog;  ///< 0 to 255 = 0 to 5 V
  std::optional<std::uint8_t> digital_in;
  std::optional<std::uint8_t> digital_out;
  std::optional<std::uint16_t> battery_x10_decivolts;
  std::optional<std::uint8_t> charge_state;  ///< 0 no, 1 bulk, 2 overcharge, 3 float
  std::optional<std::int16_t> turn_rate_decideg_per_s;
  std::optional<std::uint16_t> fault_flags;
  std::optional<std::int16_t> lateral_mm_per_s;
  std::optional<std::int8_t> temperature_c;  ///< -127: none
  std::optional<std::uint8_t> charge_percent;
  std::optional<std::uint32_t> controller_time_us;  ///< MTX only
  std::optional<std::uint32_t> flags3;              ///< MTX only

  friend bool operator==(const Sip&, const Sip&) = default;
  [[nodiscard]] bool has(std::uint16_t flag) const { return (flags & flag) != 0; }
};

[[nodiscard]] bool is_sip(std::uint8_t type);

/// From the data of a packet, type first. Refused where the fixed part up to the flags is not whole.
[[nodiscard]] std::optional<Sip> decoded_sip(std::span<const std::uint8_t> data);

/// Data of a packet, type first: the tail ends before its first empty field.
[[nodiscard]] std::vector<std::uint8_t> sip_data(const Sip& sip);
/// The whole frame.
[[nodiscard]] std::vector<std::uint8_t> encoded_sip(const Sip& sip);

}  // namespace deltamap::drivers::pioneer
