// SPDX-License-Identifier: Apache-2.0
#include "drivers/pioneer/receiver.hpp"

#include <algorithm>
#include <utility>

namespace deltamap::drivers::pioneer {
namespace {

constexpr double kVoltsPerDecivolt = 0.1;

}  // namespace

Receiver::Receiver(const PioneerParams& params)
    : decoder_{params.baud}, units_{params.model, params.by_hand}, odometry_{units_.model()} {}

/// SIPs that have waited for the reader lie one right behind another in their chunk, but were sent a cycle apart (A6):
/// dated by the line alone the robot would be ten times as fast as it is.
std::vector<Packet> Receiver::decode(std::span<const std::uint8_t> bytes, Timestamp stamp) {
  std::vector<Packet> packets = decoder_.decode(bytes, stamp);
  const std::chrono::milliseconds cycle{config_ ? config_->sip_cycle_ms : ConfigPacket{}.sip_cycle_ms};
  std::optional<Timestamp> next;
  std::for_each(packets.rbegin(), packets.rend(), [&](Packet& packet) {
    if (!is_sip(packet.type())) return;
    if (next) packet.first_byte = std::min(packet.first_byte, *next - cycle);
    next = packet.first_byte;
  });
  return packets;
}

Receiver::Content Receiver::take(const Packet& packet) {
  Content content;
  const std::uint8_t type = packet.type();
  if (is_sip(type)) {
    take_sip(packet, content);
  } else if (type == kSync2) {
    take_identity(packet, content);
  } else if (type == kConfigPacket) {
    take_config(packet, content);
  } else if (type != kSync0 && type != kSync1) {
    ++content_counts_.unknown;
  }
  return content;
}

void Receiver::take_sip(const Packet& packet, Content& content) {
  const std::optional<Sip> sip = decoded_sip(packet.data);
  if (!sip) {
    ++content_counts_.malformed;
    return;
  }
  newest_sip_ = sip;
  if (sip->sonar_is_cut) ++content_counts_.malformed;
  const std::chrono::milliseconds latency{config_ ? config_->kinematics_delay_ms : 0};
  Odometry odometry = odometry_.observe(*sip, odometry_times_.next(packet.first_byte - latency, packet.received));
  odometry.low_battery =
      config_ && odometry.battery_v > 0.0 && odometry.battery_v <= kVoltsPerDecivolt * config_->low_battery_decivolts;
  odometry.fault_flags = sip->fault_flags.value_or(0);
  content.odometry = odometry;
}

void Receiver::take_identity(const Packet& packet, Content& content) {
  config_.reset();  // of an earlier connection
  const std::optional<RobotIdentity> identity = decoded_identity(packet.data);
  if (!identity) {  // the bare echo of an old controller, or CLOSE come back
    ++content_counts_.malformed;
    return;
  }
  identity_ = identity;
  units_.forget();
  odometry_.begin_epoch();
  content.log = "robot name=" + identity->name + " type=" + identity->type + " subtype=" + identity->subtype;
  content.units = use_units_of(identity->subtype);
}

void Receiver::take_config(const Packet& packet, Content& content) {
  std::optional<ConfigPacket> config = decoded_config(packet.data);
  if (!config) {
    ++content_counts_.malformed;
    return;
  }
  config_ = std::move(config);
  content.units = use_units_of(config_->subtype);
}

RobotUnits::Line Receiver::use_units_of(const std::string& subtype) {
  RobotUnits::Line line = units_.hear(subtype);
  odometry_.set_model(units_.model());
  return line;
}

Duration Receiver::watchdog() const {
  constexpr unsigned kDefaultMs = 2000;
  const unsigned told_ms = config_ ? config_->watchdog_ms.value_or(0) : 0;
  return std::chrono::milliseconds{told_ms > 0 ? told_ms : kDefaultMs};
}

DecoderCounts Receiver::counts() const {
  DecoderCounts counts = decoder_.counts();
  counts.malformed += content_counts_.malformed;
  counts.unknown += content_counts_.unknown;
  return counts;
}

}  // namespace deltamap::drivers::pioneer
