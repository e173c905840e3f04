// SPDX-License-Identifier: Apache-2.0
#include "drivers/pioneer/status.hpp"

#include <cassert>

#include "drivers/byte_fields.hpp"
#include "drivers/pioneer/packet.hpp"

namespace deltamap::drivers::pioneer {
namespace {

constexpr unsigned kMaxSonar = 32;
constexpr std::size_t kBytesPerReading = 3;

/// The tail in wire order, for reader and writer alike. The visitor answers false where the tail ends.
template <typename SipType, typename Visitor>
void visit_tail(SipType& sip, Visitor&& visit) {
  (void)(visit(sip.grip_state) && visit(sip.analog_port) && visit(sip.analog) && visit(sip.digital_in) &&
         visit(sip.digital_out) && visit(sip.battery_x10_decivolts) && visit(sip.charge_state) &&
         visit(sip.turn_rate_decideg_per_s) && visit(sip.fault_flags) && visit(sip.lateral_mm_per_s) &&
         visit(sip.temperature_c) && visit(sip.charge_percent) && visit(sip.controller_time_us) && visit(sip.flags3));
}

void read_sonar(FieldReader& fields, Sip& sip) {
  if (fields.left() == 0) return;
  const unsigned count = fields.u8();
  if (count > kMaxSonar || fields.left() < count * kBytesPerReading) {
    sip.sonar_is_cut = true;
    return;
  }
  sip.sonar.reserve(count);
  for (unsigned i = 0; i < count; ++i) {
    const std::uint8_t index = fields.u8();
    sip.sonar.push_back({index, fields.u16()});
  }
}

void read_tail(FieldReader& fields, Sip& sip) {
  visit_tail(sip, [&fields]<typename T>(std::optional<T>& field) {
    if (fields.left() < sizeof(T)) return false;
    if constexpr (sizeof(T) == 1) {
      field = static_cast<T>(fields.u8());
    } else if constexpr (sizeof(T) == 2) {
      field = static_cast<T>(fields.u16());
    } else {
      field = static_cast<T>(fields.s32());
    }
    return true;
  });
}

}  // namespace

bool is_sip(std::uint8_t type) { return type == kSipStopped || type == kSipMoving; }

std::optional<Sip> decoded_sip(std::span<const std::uint8_t> data) {
  FieldReader fields{data};
  const std::uint8_t type = fields.u8();
  if (!is_sip(type)) return std::nullopt;
  Sip sip;
  sip.moving = type == kSipMoving;
  sip.x_units = fields.u16();
  sip.y_units = fields.u16();
  sip.heading_units = fields.s16();
  sip.left_mm_per_s = fields.s16();
  sip.right_mm_per_s = fields.s16();
  sip.battery_decivolts = fields.u8();
  const std::uint8_t stall_low = fields.u8();
  const std::uint8_t stall_high = fields.u8();
  sip.left_stall = (stall_low & 1u) != 0;
  sip.rear_bumpers = static_cast<std::uint8_t>(stall_low >> 1);
  sip.right_stall = (stall_high & 1u) != 0;
  sip.front_bumpers = static_cast<std::uint8_t>(stall_high >> 1);
  sip.control_units = fields.s16();
  sip.flags = fields.u16();
  if (!fields.is_good()) return std::nullopt;
  if (fields.left() > 0) sip.compass = fields.u8();
  read_sonar(fields, sip);
  if (!sip.sonar_is_cut) read_tail(fields, sip);
  return sip;
}

std::vector<std::uint8_t> sip_data(const Sip& sip) {
  assert(sip.sonar.size() <= kMaxSonar && "a SIP holds at most 32 sonar readings");
  FieldWriter data;
  data.u8(sip.moving ? kSipMoving : kSipStopped).u16(sip.x_units).u16(sip.y_units).s16(sip.heading_units);
  data.s16(sip.left_mm_per_s).s16(sip.right_mm_per_s).u8(sip.battery_decivolts);
  data.u8((sip.rear_bumpers << 1 & 0xFE) | (sip.left_stall ? 1u : 0u));
  data.u8((sip.front_bumpers << 1 & 0xFE) | (sip.right_stall ? 1u : 0u));
  data.s16(sip.control_units).u16(sip.flags).u8(sip.compass.value_or(0));
  data.u8(static_cast<unsigned>(sip.sonar.size()));
  for (const SonarReading& reading : sip.sonar) data.u8(reading.index).u16(reading.range_mm);
  visit_tail(sip, [&data]<typename T>(const std::optional<T>& field) {
    if (!field) return false;
    if constexpr (sizeof(T) == 4) {
      data.s32(static_cast<std::int32_t>(*field));
    } else if constexpr (sizeof(T) == 2) {
      data.u16(static_cast<std::uint16_t>(*field));
    } else {
      data.u8(static_cast<std::uint8_t>(*field));
    }
    return true;
  });
  return data.written();
}

std::vector<std::uint8_t> encoded_sip(const Sip& sip) { return encoded_packet(sip_data(sip)); }

}  // namespace deltamap::drivers::pioneer
