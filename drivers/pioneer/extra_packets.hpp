// SPDX-License-Identifier: Apache-2.0
// The other packets from the robot that we read or that the simulator sends: the SYNC echoes and the SYNC2 reply (A4),
// ENCODERpac, GYROpac and IOpac (A10).
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace deltamap::drivers::pioneer {

inline constexpr std::uint8_t kSync0 = 0x00;
inline constexpr std::uint8_t kSync1 = 0x01;
inline constexpr std::uint8_t kSync2 = 0x02;
inline constexpr std::uint8_t kEncoderPacket = 0x90;
inline constexpr std::uint8_t kGyroPacket = 0x98;
inline constexpr std::uint8_t kIoPacket = 0xF0;

/// What the robot answers to SYNC2.
struct RobotIdentity {
  std::string name;
  std::string type;     ///< "Pioneer"
  std::string subtype;  ///< "p3dx-sh", "p3dx", ...
  friend bool operator==(const RobotIdentity&, const RobotIdentity&) = default;
};

struct EncoderCounts {
  std::int32_t left_ticks = 0;
  std::int32_t right_ticks = 0;
  friend bool operator==(const EncoderCounts&, const EncoderCounts&) = default;
};

struct GyroReading {
  std::uint16_t rate = 512;  ///< 0 to 1023 around 512; less is counter-clockwise
  std::uint8_t temperature = 0;
  friend bool operator==(const GyroReading&, const GyroReading&) = default;
};

struct IoReadings {
  std::vector<std::uint8_t> digital_in;
  std::vector<std::uint8_t> digital_out;
  std::vector<std::uint16_t> analog;
  friend bool operator==(const IoReadings&, const IoReadings&) = default;
};

// Decoders take the data of a packet, type first; encoders answer the whole frame.
[[nodiscard]] std::optional<RobotIdentity> decoded_identity(std::span<const std::uint8_t> data);
[[nodiscard]] std::vector<std::uint8_t> encoded_identity(const RobotIdentity& identity);

[[nodiscard]] std::optional<EncoderCounts> decoded_encoder(std::span<const std::uint8_t> data);
[[nodiscard]] std::vector<std::uint8_t> encoded_encoder(const EncoderCounts& counts);

[[nodiscard]] std::optional<std::vector<GyroReading>> decoded_gyro(std::span<const std::uint8_t> data);
[[nodiscard]] std::vector<std::uint8_t> encoded_gyro(std::span<const GyroReading> readings);

[[nodiscard]] std::optional<IoReadings> decoded_io(std::span<const std::uint8_t> data);
[[nodiscard]] std::vector<std::uint8_t> encoded_io(const IoReadings& readings);

/// Counter-clockwise, from a raw gyro rate (A10); scaler 1.626 for the P3-DX (A7).
[[nodiscard]] double gyro_rate_rad_per_s(std::uint16_t rate, double center, double scaler);

}  // namespace deltamap::drivers::pioneer
