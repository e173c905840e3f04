// SPDX-License-Identifier: Apache-2.0
#include "drivers/pioneer/command.hpp"
#include "drivers/pioneer/config_packet.hpp"
#include "drivers/pioneer/extra_packets.hpp"
#include "drivers/pioneer/packet.hpp"
#include "drivers/pioneer/status.hpp"
#include "tool/decode/decoded_frame.hpp"

namespace deltamap::tool {
namespace {

using namespace drivers::pioneer;
using drivers::port::Direction;

constexpr unsigned kAnyBaud = 9600;  // times do not matter here

/// Commands and replies share numbers (VEL2 and CONFIGpac, HOSTBAUD and SIP): a command is known by its length, which
/// is exactly that of its one argument (protocols.md A3).
bool has_form_of_command(std::span<const std::uint8_t> data) {
  if (data.size() == 1) return true;
  switch (data[1]) {
    case 0x3B:
    case 0x1B:
      return data.size() == 4 || data.size() == 2;
    case 0x2B:
      return data.size() >= 3 && data.size() == 3u + data[2];
    default:
      return false;
  }
}

DecodedFrame command_frame(const Command& command) {
  DecodedFrame frame{command_name(command.number), "host", 0, 0, {}};
  const bool has_argument = !std::holds_alternative<std::monostate>(command.argument);
  const auto number = static_cast<unsigned>(command.number);
  if (number <= kSync2 && !has_argument) {
    frame.name = "SYNC" + std::to_string(number) + " or " + frame.name;
    frame.from = "either";
  }
  frame.fields.emplace_back("command", whole(number));
  if (const int* value = std::get_if<int>(&command.argument)) {
    frame.fields.emplace_back("argument", whole(*value));
    if (command.number == CommandNumber::kVel2) {
      const BytePair pair = byte_pair(*value);
      frame.fields.emplace_back("left", whole(pair.left));
      frame.fields.emplace_back("right", whole(pair.right));
    }
  } else if (const std::string* text = std::get_if<std::string>(&command.argument)) {
    std::vector<std::int64_t> bytes;
    for (const char c : *text) bytes.push_back(static_cast<std::uint8_t>(c));
    frame.fields.emplace_back("argument", bytes);
  }
  return frame;
}

template <typename T>
void add_if_there(NamedFields& fields, const char* name, const std::optional<T>& value) {
  if (value) fields.emplace_back(name, whole(*value));
}

DecodedFrame sip_frame(const Sip& sip) {
  DecodedFrame frame{"SIP", "robot", 0, 0, {}};
  NamedFields& f = frame.fields;
  f.emplace_back("moving", sip.moving);
  f.emplace_back("x_units", whole(sip.x_units));
  f.emplace_back("y_units", whole(sip.y_units));
  f.emplace_back("heading_units", whole(sip.heading_units));
  f.emplace_back("heading_deg", sip.heading_units * 360.0 / 4096.0);
  f.emplace_back("left_mm_per_s", whole(sip.left_mm_per_s));
  f.emplace_back("right_mm_per_s", whole(sip.right_mm_per_s));
  f.emplace_back("battery_v", sip.battery_decivolts / 10.0);
  f.emplace_back("left_stall", sip.left_stall);
  f.emplace_back("right_stall", sip.right_stall);
  f.emplace_back("front_bumpers", whole(sip.front_bumpers));
  f.emplace_back("rear_bumpers", whole(sip.rear_bumpers));
  f.emplace_back("control_units", whole(sip.control_units));
  f.emplace_back("flags", whole(sip.flags));
  f.emplace_back("motors_enabled", sip.has(sip_flag::kMotorsEnabled));
  f.emplace_back("stop_button", sip.has(sip_flag::kStopButton));
  add_if_there(f, "compass", sip.compass);
  std::vector<std::string> sonar;
  for (const SonarReading& r : sip.sonar) sonar.push_back(std::to_string(r.index) + "=" + std::to_string(r.range_mm));
  f.emplace_back("sonar_mm", sonar);
  f.emplace_back("sonar_is_cut", sip.sonar_is_cut);
  add_if_there(f, "grip_state", sip.grip_state);
  add_if_there(f, "analog_port", sip.analog_port);
  add_if_there(f, "analog", sip.analog);
  add_if_there(f, "digital_in", sip.digital_in);
  add_if_there(f, "digital_out", sip.digital_out);
  add_if_there(f, "battery_x10_decivolts", sip.battery_x10_decivolts);
  add_if_there(f, "charge_state", sip.charge_state);
  add_if_there(f, "turn_rate_decideg_per_s", sip.turn_rate_decideg_per_s);
  add_if_there(f, "fault_flags", sip.fault_flags);
  add_if_there(f, "lateral_mm_per_s", sip.lateral_mm_per_s);
  add_if_there(f, "temperature_c", sip.temperature_c);
  add_if_there(f, "charge_percent", sip.charge_percent);
  add_if_there(f, "controller_time_us", sip.controller_time_us);
  add_if_there(f, "flags3", sip.flags3);
  return frame;
}

DecodedFrame config_frame(const ConfigPacket& config) {
  DecodedFrame frame{"CONFIGpac", "robot", 0, 0, {}};
  frame.fields = {{"type", config.type},
                  {"subtype", config.subtype},
                  {"serial_number", config.serial_number},
                  {"name", config.name},
                  {"sip_cycle_ms", whole(config.sip_cycle_ms)},
                  {"host_baud", whole(config.host_baud)}};
  add_if_there(frame.fields, "watchdog_ms", config.watchdog_ms);
  const NamedFields rest{
      {"trans_vel_max", whole(config.trans_vel_max)}, {"rot_vel_max", whole(config.rot_vel_max)},
      {"front_bumpers", whole(config.front_bumpers)}, {"rear_bumpers", whole(config.rear_bumpers)},
      {"auto_baud", whole(config.auto_baud)},         {"has_gyro", whole(config.has_gyro)},
      {"rev_count", whole(config.rev_count)},         {"ticks_per_mm", whole(config.ticks_per_mm)},
      {"drift_factor", whole(config.drift_factor)},   {"low_battery_decivolts", whole(config.low_battery_decivolts)},
      {"firmware_version", config.firmware_version},  {"kinematics_delay_ms", whole(config.kinematics_delay_ms)}};
  frame.fields.insert(frame.fields.end(), rest.begin(), rest.end());
  return frame;
}

DecodedFrame gyro_frame(const std::vector<GyroReading>& readings) {
  DecodedFrame frame{"GYROpac", "robot", 0, 0, {}};
  std::vector<std::int64_t> rates;
  for (const GyroReading& reading : readings) rates.push_back(reading.rate);
  frame.fields.emplace_back("rates", rates);
  return frame;
}

DecodedFrame io_frame(const IoReadings& io) {
  DecodedFrame frame{"IOpac", "robot", 0, 0, {}};
  frame.fields = {{"digital_in", std::vector<std::int64_t>(io.digital_in.begin(), io.digital_in.end())},
                  {"digital_out", std::vector<std::int64_t>(io.digital_out.begin(), io.digital_out.end())},
                  {"analog", std::vector<std::int64_t>(io.analog.begin(), io.analog.end())}};
  return frame;
}

DecodedFrame identity_frame(const RobotIdentity& identity) {
  return {
      "SYNC2 reply", "robot", 0, 0, {{"name", identity.name}, {"type", identity.type}, {"subtype", identity.subtype}}};
}

DecodedFrame encoder_frame(const EncoderCounts& encoder) {
  return {"ENCODERpac",
          "robot",
          0,
          0,
          {{"left_ticks", whole(encoder.left_ticks)}, {"right_ticks", whole(encoder.right_ticks)}}};
}

/// Of packets whose content is not read (A10), and of the bare echoes (A4).
std::string name_of_type(std::uint8_t type) {
  switch (type) {
    case kSync0:
    case kSync1:
    case kSync2:
      return "SYNC" + std::to_string(type) + " echo";
    case 0x9A:
      return "IMUpac";
    case 0xB0:
    case 0xB8:
    case 0xC8:
      return "AUX port";
    case 0xC0:
      return "compass";
    case 0xE0:
      return "gripper";
    case 0xF8:
      return "joystick";
    case 0xFA:
      return "battery";
    default:
      return "packet of unknown type";
  }
}

std::optional<DecodedFrame> reply_frame(const Packet& packet) {
  if (const auto sip = decoded_sip(packet.data)) return sip_frame(*sip);
  if (const auto config = decoded_config(packet.data)) return config_frame(*config);
  if (const auto identity = decoded_identity(packet.data)) return identity_frame(*identity);
  if (const auto encoder = decoded_encoder(packet.data)) return encoder_frame(*encoder);
  if (const auto gyro = decoded_gyro(packet.data)) return gyro_frame(*gyro);
  if (const auto io = decoded_io(packet.data)) return io_frame(*io);
  return std::nullopt;
}

DecodedFrame raw_frame(const Packet& packet, const std::string& from) {
  DecodedFrame frame{from == "host" ? "packet of unknown type" : name_of_type(packet.type()), from, 0, 0, {}};
  frame.fields.emplace_back("type", whole(packet.type()));
  const auto body = packet.body();
  if (!body.empty()) frame.fields.emplace_back("data", std::vector<std::int64_t>(body.begin(), body.end()));
  return frame;
}

DecodedFrame frame_from(const Packet& packet, std::optional<Direction> direction) {
  const bool may_be_command = direction ? *direction == Direction::kOut : has_form_of_command(packet.data);
  if (may_be_command) {
    if (const auto command = decoded_command(packet.data)) return command_frame(*command);
  }
  if (direction != Direction::kOut) {
    if (auto reply = reply_frame(packet)) return std::move(*reply);
  }
  return raw_frame(packet, !direction ? "either" : *direction == Direction::kOut ? "host" : "robot");
}

}  // namespace

DecodedFrame robot_frame(const Packet& packet, std::optional<Direction> direction) {
  DecodedFrame frame = frame_from(packet, direction);
  frame.size = packet.data.size() + kFrameOverhead;
  if (direction == Direction::kOut) frame.from = "host";
  return frame;
}

DecodedStream decoded_robot_stream(std::span<const std::uint8_t> bytes) {
  DecodedStream stream;
  PacketDecoder decoder{kAnyBaud};
  const auto take = [&](const std::vector<Packet>& packets) {
    for (const Packet& packet : packets) {
      DecodedFrame frame = robot_frame(packet, std::nullopt);
      // Byte i was handed in at i ns.
      frame.at = static_cast<std::size_t>(unix_ns(packet.received)) + 1 - frame.size;
      stream.frames.push_back(std::move(frame));
    }
  };
  for (std::size_t i = 0; i < bytes.size(); ++i) {
    take(decoder.decode(bytes.subspan(i, 1), timestamp_from_ns(static_cast<std::int64_t>(i))));
  }
  take(decoder.finish());
  stream.counts = decoder.counts();
  return stream;
}

}  // namespace deltamap::tool
