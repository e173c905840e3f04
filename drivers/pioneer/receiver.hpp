// SPDX-License-Identifier: Apache-2.0
// What comes from a Pioneer's controller, live or in a recording: takes bytes, answers packets, Odometry with its
// times, and what the robot has said about itself (protocols.md A1, A6 to A8, A10). Knows nothing of the conversation:
// it never asks for anything.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "core/messages.hpp"
#include "core/time.hpp"
#include "drivers/decoder_counts.hpp"
#include "drivers/monotonic_times.hpp"
#include "drivers/pioneer/config_packet.hpp"
#include "drivers/pioneer/extra_packets.hpp"
#include "drivers/pioneer/motion_limits.hpp"
#include "drivers/pioneer/odometry.hpp"
#include "drivers/pioneer/packet.hpp"
#include "drivers/pioneer/params.hpp"
#include "drivers/pioneer/robot_units.hpp"
#include "drivers/pioneer/status.hpp"

namespace deltamap::drivers::pioneer {

class Receiver {
 public:
  /// Throws std::invalid_argument for a model that nobody knows.
  explicit Receiver(const PioneerParams& params);

  [[nodiscard]] std::vector<Packet> decode(std::span<const std::uint8_t> bytes, Timestamp stamp);

  struct Content {
    std::optional<Odometry> odometry;  ///< of a SIP
    RobotUnits::Line units;
    std::string log;  ///< empty: nothing to tell
  };
  /// Reads what a packet says. Each is taken once, before the next is.
  [[nodiscard]] Content take(const Packet& packet);

  void set_baud(unsigned baud) { decoder_.set_baud(baud); }
  [[nodiscard]] unsigned baud() const { return decoder_.baud(); }
  [[nodiscard]] std::size_t awaited_bytes() const { return decoder_.awaited_bytes(); }
  [[nodiscard]] DecoderCounts counts() const;

  // What the robot has said about itself, once it did.
  [[nodiscard]] const std::optional<RobotIdentity>& identity() const { return identity_; }
  /// Of this connection.
  [[nodiscard]] const std::optional<ConfigPacket>& config() const { return config_; }
  [[nodiscard]] const std::optional<Sip>& newest_sip() const { return newest_sip_; }
  [[nodiscard]] bool knows_watchdog() const { return config_ && config_->watchdog_ms; }
  /// As told, or as delivered.
  [[nodiscard]] Duration watchdog() const;
  /// How the robot comes to rest without us, by what its controller has confirmed.
  [[nodiscard]] StoppingLimits stopping_limits() const { return stopping_limits_of(config_); }
  /// Its units are not known for sure; empty: they are.
  [[nodiscard]] const std::string& why_never_driven() const { return units_.why_never_driven(); }

 private:
  void take_sip(const Packet& packet, Content& content);
  void take_identity(const Packet& packet, Content& content);
  void take_config(const Packet& packet, Content& content);
  [[nodiscard]] RobotUnits::Line use_units_of(const std::string& subtype);

  PacketDecoder decoder_;
  RobotUnits units_;
  OdometryTracker odometry_;
  MonotonicTimes odometry_times_;
  DecoderCounts content_counts_;  // malformed and unknown, on top of the decoder's own
  std::optional<RobotIdentity> identity_;
  std::optional<ConfigPacket> config_;
  std::optional<Sip> newest_sip_;
};

}  // namespace deltamap::drivers::pioneer
