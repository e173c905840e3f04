// SPDX-License-Identifier: Apache-2.0
// A device's transmitter: bytes leave one after another at the line's speed and arrive at the host as they would on a
// wire. Where host and device disagree on the speed, garbage arrives.
#pragma once

#include <cstdint>
#include <deque>
#include <optional>
#include <span>
#include <vector>

#include "core/random.hpp"
#include "core/time.hpp"

namespace deltamap::simulation::devices {

/// 8N1: start bit, eight data bits, stop bit.
[[nodiscard]] Duration byte_duration(unsigned baud);

/// What a receiver at one speed makes of bytes sent at another.
[[nodiscard]] std::vector<std::uint8_t> garbled(std::span<const std::uint8_t> bytes, unsigned sent_baud,
                                                unsigned received_baud, Random& random);

class SerialLine {
 public:
  SerialLine(unsigned baud, Random random) : baud_{baud}, random_{random} {}

  /// Queues bytes that begin to leave at `not_before`, or when all before them have left.
  void send(std::span<const std::uint8_t> bytes, Timestamp not_before);

  /// What has not begun to leave by now never will.
  void interrupt(Timestamp now);

  /// For the bytes that are sent from now on.
  void set_baud(unsigned baud) { baud_ = baud; }
  [[nodiscard]] unsigned baud() const { return baud_; }

  /// The bytes that have arrived since the last call, as a host at this speed reads them.
  [[nodiscard]] std::vector<std::uint8_t> arrived(Timestamp now, unsigned host_baud);

  /// When the last queued byte will have left; the past where nothing is queued.
  [[nodiscard]] Timestamp idle_at() const { return idle_at_; }
  /// When the burst that is leaving now will be whole; none where nothing is queued.
  [[nodiscard]] std::optional<Timestamp> burst_whole_at() const;

 private:
  struct Burst {
    std::vector<std::uint8_t> bytes;
    Timestamp begin;
    unsigned baud;
    std::size_t taken = 0;

    [[nodiscard]] std::size_t complete_at(Timestamp now) const;
    [[nodiscard]] Timestamp end() const { return begin + byte_duration(baud) * static_cast<int>(bytes.size()); }
  };

  unsigned baud_;
  Random random_;
  std::deque<Burst> bursts_;
  Timestamp idle_at_{};
};

}  // namespace deltamap::simulation::devices
