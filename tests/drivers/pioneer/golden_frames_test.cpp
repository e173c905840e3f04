// SPDX-License-Identifier: Apache-2.0
// The golden frames of tests/data in both directions: what a clone alone holds the ARCOS codecs against.
#include <gtest/gtest.h>

#include <algorithm>

#include "drivers/pioneer/command.hpp"
#include "drivers/pioneer/config_packet.hpp"
#include "drivers/pioneer/extra_packets.hpp"
#include "drivers/pioneer/packet.hpp"
#include "drivers/pioneer/status.hpp"
#include "tests/support/bytes/golden_frames.hpp"
#include "tests/support/bytes/hex.hpp"
#include "tests/support/files/figure.hpp"

namespace deltamap::drivers::pioneer {
namespace {

using nlohmann::json;
using tests::golden_stream;
using tests::GoldenFrame;
using tests::hex_of;

std::vector<Packet> packets_of(std::span<const std::uint8_t> bytes) {
  PacketDecoder decoder{9600};
  auto packets = decoder.decode(bytes, Timestamp{});
  for (Packet& packet : decoder.finish()) packets.push_back(std::move(packet));
  return packets;
}

/// `ours` as json, field by field, but for those that only place the frame.
void expect_fields(const GoldenFrame& frame, json ours) {
  json expected = frame.fields;
  for (const char* place : {"at", "size", "name", "command"}) expected.erase(place);
  EXPECT_EQ(ours, expected) << frame.name() << ": " << json::diff(expected, ours);
}

json fields_of(const Sip& sip) {
  json fields{{"moving", sip.moving},
              {"x_units", sip.x_units},
              {"y_units", sip.y_units},
              {"heading_units", sip.heading_units},
              {"left_mm_per_s", sip.left_mm_per_s},
              {"right_mm_per_s", sip.right_mm_per_s},
              {"battery_decivolts", sip.battery_decivolts},
              {"left_stall", sip.left_stall},
              {"right_stall", sip.right_stall},
              {"rear_bumpers", sip.rear_bumpers},
              {"front_bumpers", sip.front_bumpers},
              {"control_units", sip.control_units},
              {"flags", sip.flags},
              {"sonar", json::array()}};
  for (const SonarReading& reading : sip.sonar) fields["sonar"].push_back({reading.index, reading.range_mm});
  const auto add = [&](const char* name, const auto& value) {
    if (value) fields[name] = *value;
  };
  add("compass", sip.compass);
  add("grip_state", sip.grip_state);
  add("analog_port", sip.analog_port);
  add("analog", sip.analog);
  add("digital_in", sip.digital_in);
  add("digital_out", sip.digital_out);
  add("battery_x10_decivolts", sip.battery_x10_decivolts);
  add("charge_state", sip.charge_state);
  add("turn_rate_decideg_per_s", sip.turn_rate_decideg_per_s);
  add("fault_flags", sip.fault_flags);
  add("lateral_mm_per_s", sip.lateral_mm_per_s);
  add("temperature_c", sip.temperature_c);
  add("charge_percent", sip.charge_percent);
  add("controller_time_us", sip.controller_time_us);
  add("flags3", sip.flags3);
  return fields;
}

json fields_of(const ConfigPacket& c) {
  json fields{{"type", c.type}, {"subtype", c.subtype}, {"serial_number", c.serial_number}};
  fields["robot"] = c.name;
  fields["firmware_version"] = c.firmware_version;
#define ADD(field) fields[#field] = c.field
  ADD(four_motors), ADD(rot_vel_top), ADD(trans_vel_top), ADD(rot_acc_top), ADD(trans_acc_top), ADD(pwm_max);
  ADD(sip_cycle_ms), ADD(host_baud), ADD(aux1_baud), ADD(has_gripper), ADD(front_sonar), ADD(rear_sonar);
  ADD(low_battery_decivolts), ADD(rev_count), ADD(p2_mpacs), ADD(stall_val), ADD(stall_count_ms);
  ADD(joy_vel), ADD(joy_rot_vel), ADD(rot_vel_max), ADD(trans_vel_max), ADD(rot_acc), ADD(rot_decel), ADD(rot_kp);
  ADD(rot_kv), ADD(rot_ki), ADD(trans_acc), ADD(trans_decel), ADD(trans_kp), ADD(trans_kv), ADD(trans_ki);
  ADD(front_bumpers), ADD(rear_bumpers), ADD(charger), ADD(sonar_cycle_ms), ADD(auto_baud), ADD(has_gyro);
  ADD(drift_factor), ADD(aux2_baud), ADD(aux3_baud), ADD(ticks_per_mm), ADD(shutdown_decivolts), ADD(gyro_cw);
  ADD(gyro_ccw), ADD(kinematics_delay_ms), ADD(lat_vel_top), ADD(lat_acc_top), ADD(lat_vel_max), ADD(lat_acc);
  ADD(lat_decel), ADD(charge_threshold), ADD(pdb_port), ADD(gyro_rate_limit), ADD(high_temperature), ADD(power_bits);
  ADD(battery_type), ADD(soc_low), ADD(soc_shutdown);
#undef ADD
  if (c.watchdog_ms) fields["watchdog_ms"] = *c.watchdog_ms;
  return fields;
}

/// The frame read by the decoder of its kind and written again by its encoder.
template <typename Decode, typename Encode, typename Fields>
void expect_both_ways(const GoldenFrame& frame, Decode decode, Encode encode, Fields fields) {
  const auto packets = packets_of(frame.bytes);
  ASSERT_EQ(packets.size(), 1u) << frame.name();
  const auto decoded = decode(packets[0].data);
  ASSERT_TRUE(decoded) << frame.name() << " " << hex_of(frame.bytes);
  expect_fields(frame, fields(*decoded));
  EXPECT_EQ(hex_of(encode(*decoded)), hex_of(frame.bytes)) << frame.name();
}

TEST(PioneerFrames, AStreamOfThemIsCutWhereTheyEnd) {
  std::size_t frames = 0;
  for (const char* name : {"arcos_commands", "arcos_packets"}) {
    const auto stream = golden_stream(name);
    const auto packets = packets_of(stream.bytes);
    ASSERT_EQ(packets.size(), stream.frames.size()) << name;
    for (std::size_t i = 0; i < packets.size(); ++i) {
      EXPECT_EQ(hex_of(encoded_packet(packets[i].data)), hex_of(stream.frames[i].bytes)) << stream.frames[i].name();
    }
    frames += packets.size();
  }
  test::tell_figure("arcos_frames", static_cast<double>(frames));
}

TEST(PioneerFrames, CommandsHaveTheirNamesArgumentsAndBytes) {
  for (const GoldenFrame& frame : golden_stream("arcos_commands").frames) {
    expect_both_ways(frame, decoded_command, encoded_command, [&](const Command& command) {
      EXPECT_EQ(command_name(command.number), frame.name());
      EXPECT_EQ(static_cast<int>(command.number), frame.fields["command"]) << frame.name();
      json fields = json::object();
      if (command.number == CommandNumber::kVel2) {
        const BytePair pair = byte_pair(command.integer_or(0));
        fields = {{"left", pair.left}, {"right", pair.right}};
      } else if (const int* number = std::get_if<int>(&command.argument)) {
        fields["argument"] = *number;
      } else if (const std::string* text = std::get_if<std::string>(&command.argument)) {
        fields["text"] = hex_of(std::vector<std::uint8_t>(text->begin(), text->end()));
      }
      return fields;
    });
  }
}

TEST(PioneerFrames, InformationPacketsHaveTheirFieldsAndBytes) {
  std::size_t seen = 0;
  for (const GoldenFrame& frame : golden_stream("arcos_packets").frames) {
    if (frame.name() != "SIP") continue;
    ++seen;
    expect_both_ways(frame, decoded_sip, encoded_sip, [](const Sip& sip) { return fields_of(sip); });
  }
  EXPECT_EQ(seen, 5u);
}

TEST(PioneerFrames, OtherPacketsHaveTheirFieldsAndBytes) {
  std::vector<std::string> seen;
  for (const GoldenFrame& frame : golden_stream("arcos_packets").frames) {
    seen.push_back(frame.name());
    if (frame.name() == "identity") {
      expect_both_ways(frame, decoded_identity, encoded_identity, [](const RobotIdentity& identity) {
        return json{{"robot", identity.name}, {"type", identity.type}, {"subtype", identity.subtype}};
      });
    } else if (frame.name() == "CONFIGpac") {
      expect_both_ways(frame, decoded_config, encoded_config, [](const ConfigPacket& c) { return fields_of(c); });
    } else if (frame.name() == "ENCODERpac") {
      expect_both_ways(frame, decoded_encoder, encoded_encoder, [](const EncoderCounts& counts) {
        return json{{"left_ticks", counts.left_ticks}, {"right_ticks", counts.right_ticks}};
      });
    } else if (frame.name() == "GYROpac") {
      expect_both_ways(frame, decoded_gyro, encoded_gyro, [](const std::vector<GyroReading>& readings) {
        json list = json::array();
        for (const GyroReading& one : readings) list.push_back({one.rate, one.temperature});
        return json{{"readings", list}};
      });
    } else if (frame.name() == "IOpac") {
      expect_both_ways(frame, decoded_io, encoded_io, [](const IoReadings& io) {
        return json{{"digital_in", io.digital_in}, {"digital_out", io.digital_out}, {"analog", io.analog}};
      });
    }
  }
  for (const char* name : {"SYNC0", "SYNC1", "identity", "CONFIGpac", "ENCODERpac", "GYROpac", "IOpac"}) {
    EXPECT_EQ(std::count(seen.begin(), seen.end(), name) > 0, true) << name;
  }
}

}  // namespace
}  // namespace deltamap::drivers::pioneer
