// SPDX-License-Identifier: Apache-2.0
#include "drivers/pioneer/extra_packets.hpp"

#include "core/geometry/angle.hpp"
#include "drivers/byte_fields.hpp"
#include "drivers/pioneer/packet.hpp"

namespace deltamap::drivers::pioneer {

std::optional<RobotIdentity> decoded_identity(std::span<const std::uint8_t> data) {
  FieldReader fields{data};
  if (fields.u8() != kSync2) return std::nullopt;
  RobotIdentity identity;
  identity.name = fields.zero_ended_text();
  identity.type = fields.zero_ended_text();
  identity.subtype = fields.zero_ended_text();
  if (!fields.is_good()) return std::nullopt;
  return identity;
}

std::vector<std::uint8_t> encoded_identity(const RobotIdentity& identity) {
  FieldWriter data;
  data.u8(kSync2);
  data.zero_ended_text(identity.name).zero_ended_text(identity.type).zero_ended_text(identity.subtype);
  return encoded_packet(data.written());
}

std::optional<EncoderCounts> decoded_encoder(std::span<const std::uint8_t> data) {
  FieldReader fields{data};
  if (fields.u8() != kEncoderPacket) return std::nullopt;
  EncoderCounts counts;
  counts.left_ticks = fields.s32();
  counts.right_ticks = fields.s32();
  if (!fields.is_good()) return std::nullopt;
  return counts;
}

std::vector<std::uint8_t> encoded_encoder(const EncoderCounts& counts) {
  return encoded_packet(FieldWriter{}.u8(kEncoderPacket).s32(counts.left_ticks).s32(counts.right_ticks).written());
}

std::optional<std::vector<GyroReading>> decoded_gyro(std::span<const std::uint8_t> data) {
  FieldReader fields{data};
  if (fields.u8() != kGyroPacket) return std::nullopt;
  std::vector<GyroReading> readings(fields.u8());
  for (GyroReading& reading : readings) {
    reading.rate = fields.u16();
    reading.temperature = fields.u8();
  }
  if (!fields.is_good()) return std::nullopt;
  return readings;
}

std::vector<std::uint8_t> encoded_gyro(std::span<const GyroReading> readings) {
  FieldWriter data;
  data.u8(kGyroPacket).u8(static_cast<unsigned>(readings.size()));
  for (const GyroReading& reading : readings) data.u16(reading.rate).u8(reading.temperature);
  return encoded_packet(data.written());
}

std::optional<IoReadings> decoded_io(std::span<const std::uint8_t> data) {
  FieldReader fields{data};
  if (fields.u8() != kIoPacket) return std::nullopt;
  IoReadings readings;
  readings.digital_in.resize(fields.u8());
  for (std::uint8_t& byte : readings.digital_in) byte = fields.u8();
  readings.digital_out.resize(fields.u8());
  for (std::uint8_t& byte : readings.digital_out) byte = fields.u8();
  readings.analog.resize(fields.u8());
  for (std::uint16_t& word : readings.analog) word = fields.u16();
  if (!fields.is_good()) return std::nullopt;
  return readings;
}

std::vector<std::uint8_t> encoded_io(const IoReadings& readings) {
  FieldWriter data;
  data.u8(kIoPacket);
  data.u8(static_cast<unsigned>(readings.digital_in.size())).bytes(readings.digital_in);
  data.u8(static_cast<unsigned>(readings.digital_out.size())).bytes(readings.digital_out);
  data.u8(static_cast<unsigned>(readings.analog.size()));
  for (const std::uint16_t word : readings.analog) data.u16(word);
  return encoded_packet(data.written());
}

double gyro_rate_rad_per_s(std::uint16_t rate, double center, double scaler) {
  const double degrees_per_s = -(static_cast<double>(rate) - center) * 5.0 / 1023.0 * 300.0 / 2.5 * scaler;
  return radians(degrees_per_s);
}

}  // namespace deltamap::drivers::pioneer
