// SPDX-License-Identifier: Apache-2.0
// A device's transmitter: bytes leave one after another at the line's speed and arrive at the host as they would on a
// wire. Where host and device disagree on the speed, garbage arrives; on order the line does worse.
#pragma once

#include <cstdint>
#include <deque>
#include <functional>
#include <optional>
#include <span>
#include <vector>

#include "core/random.hpp"
#include "core/time.hpp"
#include "simulation/devices/line_faults.hpp"

namespace deltamap::simulation::devices {

/// 8N1: start bit, eight data bits, stop bit.
[[nodiscard]] Duration byte_duration(unsigned baud);

/// Of a stream of bytes that has no speed: always right.
inline constexpr unsigned kAnyBaud = 0xFFFF'FFFF;

/// What a receiver at one speed makes of bytes sent at another.
[[nodiscard]] std::vector<std::uint8_t> garbled(std::span<const std::uint8_t> bytes, unsigned sent_baud,
                                                unsigned received_baud, Random& random);

class SerialLine {
 public:
  SerialLine(unsigned baud, Random random) : baud_{baud}, random_{random} {}

  /// Queues a frame that begins to leave at `not_before`, or when all before it has left.
  void send(std::span<const std::uint8_t> bytes, Timestamp not_before);

  /// What has not begun to leave by now never will.
  void interrupt(Timestamp now);

  /// For the bytes that are sent from now on.
  void set_baud(unsigned baud) { baud_ = baud; }
  /// At which it speaks, and at which its device must be spoken to.
  [[nodiscard]] unsigned baud() const { return faults_.baud.value_or(baud_); }

  /// From now on.
  void suffer(const LineFaults& faults) { faults_ = faults; }
  /// Hears every frame as it is before the line damages it.
  using Witness = std::function<void(std::span<const std::uint8_t> frame, Timestamp not_before)>;
  void set_witness(Witness witness) { witness_ = std::move(witness); }

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

  [[nodiscard]] std::vector<std::uint8_t> damaged(std::span<const std::uint8_t> frame);
  void queue(std::span<const std::uint8_t> bytes, Timestamp not_before);

  unsigned baud_;
  Random random_;
  LineFaults faults_;
  Witness witness_;
  std::deque<Burst> bursts_;
  Timestamp idle_at_{};
};

}  // namespace deltamap::simulation::devices
