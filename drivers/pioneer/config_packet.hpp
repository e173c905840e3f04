// SPDX-License-Identifier: Apache-2.0
// CONFIGpac (protocols.md A10): what the controller's flash says about this robot. Firmware versions stop at different
// fields; those that did not come keep their defaults, but for the watchdog: what it is decides whether the robot is
// driven.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace deltamap::drivers::pioneer {

inline constexpr std::uint8_t kConfigPacket = 0x20;

/// In wire order. Units as on the wire: mm/s, deg/s, ms, decivolts.
struct ConfigPacket {
  std::string type = "Pioneer";
  std::string subtype = "p3dx-sh";
  std::string serial_number;
  std::uint8_t four_motors = 0;
  std::uint16_t rot_vel_top = 500;
  std::uint16_t trans_vel_top = 2200;
  std::uint16_t rot_acc_top = 300;
  std::uint16_t trans_acc_top = 2000;
  std::uint16_t pwm_max = 500;
  std::string name;
  std::uint8_t sip_cycle_ms = 100;
  std::uint8_t host_baud = 0;  ///< code as HOSTBAUD
  std::uint8_t aux1_baud = 0;
  std::uint16_t has_gripper = 0;
  std::uint16_t front_sonar = 1;
  std::uint8_t rear_sonar = 0;
  std::uint16_t low_battery_decivolts = 110;
  std::uint16_t rev_count = 16570;
  std::optional<std::uint16_t> watchdog_ms = 2000;  ///< 0: none; nothing: the packet has ended before
  std::uint8_t p2_mpacs = 0;
  std::uint16_t stall_val = 200;
  std::uint16_t stall_count_ms = 100;
  std::uint16_t joy_vel = 500;
  std::uint16_t joy_rot_vel = 100;
  std::uint16_t rot_vel_max = 100;
  std::uint16_t trans_vel_max = 750;
  std::uint16_t rot_acc = 100;
  std::uint16_t rot_decel = 100;
  std::uint16_t rot_kp = 40;
  std::uint16_t rot_kv = 20;
  std::uint16_t rot_ki = 0;
  std::uint16_t trans_acc = 300;
  std::uint16_t trans_decel = 300;
  std::uint16_t trans_kp = 40;
  std::uint16_t trans_kv = 20;
  std::uint16_t trans_ki = 0;
  std::uint8_t front_bumpers = 0;
  std::uint8_t rear_bumpers = 0;
  std::uint8_t charger = 0;
  std::uint8_t sonar_cycle_ms = 40;
  std::uint8_t auto_baud = 0;  ///< 0 no, 1 can change, 2 autobaud
  std::uint8_t has_gyro = 0;   ///< 0 none, 1 for the client, 2 the controller corrects the heading itself
  std::int16_t drift_factor = 0;
  std::uint8_t aux2_baud = 0;
  std::uint8_t aux3_baud = 0;
  std::uint16_t ticks_per_mm = 128;
  std::uint16_t shutdown_decivolts = 0;
  std::string firmware_version;
  std::uint16_t gyro_cw = 0;
  std::uint16_t gyro_ccw = 0;
  std::uint8_t kinematics_delay_ms = 0;  ///< latency of the odometry
  std::uint16_t lat_vel_top = 0;
  std::uint16_t lat_acc_top = 0;
  std::uint16_t lat_vel_max = 0;
  std::uint16_t lat_acc = 0;
  std::uint16_t lat_decel = 0;
  std::uint16_t charge_threshold = 0;
  std::uint8_t pdb_port = 0;
  std::uint16_t gyro_rate_limit = 0;
  std::uint8_t high_temperature = 0;
  std::uint16_t power_bits = 0;
  std::uint8_t battery_type = 0;
  std::uint16_t soc_low = 0;
  std::uint16_t soc_shutdown = 0;

  friend bool operator==(const ConfigPacket&, const ConfigPacket&) = default;
};

/// From the data of a packet, type first. Refused unless type and subtype are whole. Bytes after the last known field
/// are ignored.
[[nodiscard]] std::optional<ConfigPacket> decoded_config(std::span<const std::uint8_t> data);

/// The whole frame with every field; it ends before a watchdog that is nothing. The strings together must leave room in
/// one packet (at most 80 bytes).
[[nodiscard]] std::vector<std::uint8_t> encoded_config(const ConfigPacket& config);

}  // namespace deltamap::drivers::pioneer
