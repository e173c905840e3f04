// SPDX-License-Identifier: Apache-2.0
#include "drivers/lms200/status.hpp"

#include <algorithm>

#include "drivers/byte_fields.hpp"
#include "drivers/lms200/command.hpp"

namespace deltamap::drivers::lms200 {
namespace {

constexpr std::size_t kDataSize = 152;
constexpr std::size_t kVersionSize = 7;

struct BaudCode {
  unsigned baud;
  std::uint16_t code;
};

constexpr auto kBaudCodes =
    std::to_array<BaudCode>({{500000, 0x8001}, {38400, 0x8019}, {19200, 0x8033}, {9600, 0x8067}});

/// A reader that stands at a field of B5.
FieldReader at(const std::vector<std::uint8_t>& data, std::size_t offset_from_response) {
  return FieldReader{std::span{data}.subspan(offset_from_response - 1)};
}

std::uint8_t byte_at(const std::vector<std::uint8_t>& data, std::size_t offset) { return data[offset - 1]; }
std::uint16_t word_at(const std::vector<std::uint8_t>& data, std::size_t offset) { return at(data, offset).u16(); }

void put_byte(std::vector<std::uint8_t>& data, std::size_t offset, std::uint8_t value) { data[offset - 1] = value; }
void put_word(std::vector<std::uint8_t>& data, std::size_t offset, std::uint16_t value) {
  data[offset - 1] = static_cast<std::uint8_t>(value & 0xFF);
  data[offset] = static_cast<std::uint8_t>(value >> 8);
}
void put_version(std::vector<std::uint8_t>& data, std::size_t offset, const std::string& version) {
  for (std::size_t i = 0; i < kVersionSize; ++i) {
    put_byte(data, offset + i, i < version.size() ? static_cast<std::uint8_t>(version[i]) : ' ');
  }
}

}  // namespace

std::optional<unsigned> DeviceStatus::baud() const {
  const auto* found =
      std::find_if(kBaudCodes.begin(), kBaudCodes.end(), [&](const BaudCode& b) { return b.code == baud_code; });
  return found != kBaudCodes.end() ? std::optional{found->baud} : std::nullopt;
}

std::optional<std::uint16_t> baud_code(unsigned baud) {
  const auto* found =
      std::find_if(kBaudCodes.begin(), kBaudCodes.end(), [&](const BaudCode& b) { return b.baud == baud; });
  return found != kBaudCodes.end() ? std::optional{found->code} : std::nullopt;
}

std::optional<DeviceStatus> decoded_status(const Telegram& telegram) {
  if (telegram.kind != Telegram::Kind::kTelegram || telegram.command != response::kStatus) return std::nullopt;
  const std::vector<std::uint8_t>& data = telegram.data;
  if (data.size() < kDataSize) return std::nullopt;
  DeviceStatus status;
  status.software_version = at(data, 1).text(kVersionSize);
  status.operating_mode = byte_at(data, 8);
  status.fault = byte_at(data, 9);
  status.variant_type = byte_at(data, 18);
  for (std::size_t i = 0; i < status.pollution.size(); ++i) status.pollution[i] = word_at(data, 19 + 2 * i);
  for (std::size_t i = 0; i < status.reference_pollution.size(); ++i) {
    status.reference_pollution[i] = word_at(data, 35 + 2 * i);
  }
  status.motor_revolutions = word_at(data, 67);
  status.measuring_mode = byte_at(data, 102);
  status.scan_angle_deg = word_at(data, 107);
  status.resolution_centideg = word_at(data, 109);
  status.restart_mode = byte_at(data, 111);
  status.restart_time = word_at(data, 112);
  status.baud_code = word_at(data, 116);
  status.evaluations = byte_at(data, 118);
  status.permanent_baud = byte_at(data, 119);
  status.address = byte_at(data, 120);
  status.field_set = byte_at(data, 121);
  status.units = byte_at(data, 122);
  status.laser_on = byte_at(data, 123);
  status.boot_version = at(data, 124).text(kVersionSize);
  return status;
}

std::vector<std::uint8_t> status_reply(const DeviceStatus& status) {
  std::vector<std::uint8_t> data(kDataSize, 0);
  put_version(data, 1, status.software_version);
  put_byte(data, 8, status.operating_mode);
  put_byte(data, 9, status.fault);
  put_byte(data, 18, status.variant_type);
  for (std::size_t i = 0; i < status.pollution.size(); ++i) put_word(data, 19 + 2 * i, status.pollution[i]);
  for (std::size_t i = 0; i < status.reference_pollution.size(); ++i) {
    put_word(data, 35 + 2 * i, status.reference_pollution[i]);
  }
  put_word(data, 67, status.motor_revolutions);
  put_byte(data, 102, status.measuring_mode);
  put_word(data, 107, status.scan_angle_deg);
  put_word(data, 109, status.resolution_centideg);
  put_byte(data, 111, status.restart_mode);
  put_word(data, 112, status.restart_time);
  put_word(data, 116, status.baud_code);
  put_byte(data, 118, status.evaluations);
  put_byte(data, 119, status.permanent_baud);
  put_byte(data, 120, status.address);
  put_byte(data, 121, status.field_set);
  put_byte(data, 122, status.units);
  put_byte(data, 123, status.laser_on);
  put_version(data, 124, status.boot_version);
  return encoded_reply(response::kStatus, data);
}

}  // namespace deltamap::drivers::lms200
