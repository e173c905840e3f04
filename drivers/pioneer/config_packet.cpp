// SPDX-License-Identifier: Apache-2.0
#include "drivers/pioneer/config_packet.hpp"

#include "drivers/byte_fields.hpp"
#include "drivers/pioneer/packet.hpp"

namespace deltamap::drivers::pioneer {
namespace {

/// Every field in wire order, for reader and writer alike. The visitor answers false where the packet ends.
template <typename Config, typename Visitor>
void visit_fields(Config& c, Visitor&& visit) {
  (void)(visit(c.type) && visit(c.subtype) && visit(c.serial_number) && visit(c.four_motors) && visit(c.rot_vel_top) &&
         visit(c.trans_vel_top) && visit(c.rot_acc_top) && visit(c.trans_acc_top) && visit(c.pwm_max) &&
         visit(c.name) && visit(c.sip_cycle_ms) && visit(c.host_baud) && visit(c.aux1_baud) && visit(c.has_gripper) &&
         visit(c.front_sonar) && visit(c.rear_sonar) && visit(c.low_battery_decivolts) && visit(c.rev_count) &&
         visit(c.watchdog_ms) && visit(c.p2_mpacs) && visit(c.stall_val) && visit(c.stall_count_ms) &&
         visit(c.joy_vel) && visit(c.joy_rot_vel) && visit(c.rot_vel_max) && visit(c.trans_vel_max) &&
         visit(c.rot_acc) && visit(c.rot_decel) && visit(c.rot_kp) && visit(c.rot_kv) && visit(c.rot_ki) &&
         visit(c.trans_acc) && visit(c.trans_decel) && visit(c.trans_kp) && visit(c.trans_kv) && visit(c.trans_ki) &&
         visit(c.front_bumpers) && visit(c.rear_bumpers) && visit(c.charger) && visit(c.sonar_cycle_ms) &&
         visit(c.auto_baud) && visit(c.has_gyro) && visit(c.drift_factor) && visit(c.aux2_baud) && visit(c.aux3_baud) &&
         visit(c.ticks_per_mm) && visit(c.shutdown_decivolts) && visit(c.firmware_version) && visit(c.gyro_cw) &&
         visit(c.gyro_ccw) && visit(c.kinematics_delay_ms) && visit(c.lat_vel_top) && visit(c.lat_acc_top) &&
         visit(c.lat_vel_max) && visit(c.lat_acc) && visit(c.lat_decel) && visit(c.charge_threshold) &&
         visit(c.pdb_port) && visit(c.gyro_rate_limit) && visit(c.high_temperature) && visit(c.power_bits) &&
         visit(c.battery_type) && visit(c.soc_low) && visit(c.soc_shutdown));
}

struct Reading {
  FieldReader& fields;
  unsigned read = 0;

  bool operator()(std::string& field) {
    const std::string text = fields.zero_ended_text();
    return accept([&] { field = text; });
  }
  bool operator()(std::uint8_t& field) {
    const std::uint8_t value = fields.u8();
    return accept([&] { field = value; });
  }
  bool operator()(std::uint16_t& field) {
    const std::uint16_t value = fields.u16();
    return accept([&] { field = value; });
  }
  bool operator()(std::int16_t& field) {
    const std::int16_t value = fields.s16();
    return accept([&] { field = value; });
  }
  bool operator()(std::optional<std::uint16_t>& field) {
    const std::uint16_t value = fields.u16();
    return accept([&] { field = value; });
  }

  template <typename Assign>
  bool accept(Assign&& assign) {
    if (!fields.is_good()) return false;
    assign();
    ++read;
    return true;
  }
};

struct Writing {
  FieldWriter& data;

  bool operator()(const std::string& field) { return data.zero_ended_text(field), true; }
  bool operator()(std::uint8_t field) { return data.u8(field), true; }
  bool operator()(std::uint16_t field) { return data.u16(field), true; }
  bool operator()(std::int16_t field) { return data.s16(field), true; }
  bool operator()(const std::optional<std::uint16_t>& field) { return field && (data.u16(*field), true); }
};

}  // namespace

std::optional<ConfigPacket> decoded_config(std::span<const std::uint8_t> data) {
  FieldReader fields{data};
  if (fields.u8() != kConfigPacket) return std::nullopt;
  ConfigPacket config;
  config.watchdog_ms.reset();
  Reading reading{fields};
  visit_fields(config, reading);
  constexpr unsigned kTypeAndSubtype = 2;
  if (reading.read < kTypeAndSubtype) return std::nullopt;
  return config;
}

std::vector<std::uint8_t> encoded_config(const ConfigPacket& config) {
  FieldWriter data;
  data.u8(kConfigPacket);
  visit_fields(config, Writing{data});
  return encoded_packet(data.written());
}

}  // namespace deltamap::drivers::pioneer
