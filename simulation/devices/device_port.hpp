// SPDX-License-Identifier: Apache-2.0
// The simulator's end of a port that a program opens.
#pragma once

#include <poll.h>

#include <cstdint>
#include <span>
#include <vector>

namespace deltamap::simulation::devices {

class DevicePort {
 public:
  virtual ~DevicePort() = default;

  /// Whether a program holds the other end open. What is written while none does is lost, as on a wire.
  [[nodiscard]] virtual bool is_open_elsewhere() const = 0;
  /// The speed to which the program has set its end; 0 for one that serial lines do not have; kAnyBaud where there is
  /// none.
  [[nodiscard]] virtual unsigned baud() const = 0;

  /// What has come since the last call; never waits.
  [[nodiscard]] virtual std::vector<std::uint8_t> read() = 0;
  /// Never waits: what the program does not fetch in time is lost, as on a wire.
  virtual void write(std::span<const std::uint8_t> bytes) = 0;

  /// Adds what tells that there is something to read.
  virtual void watch(std::vector<pollfd>& watched) const = 0;
};

}  // namespace deltamap::simulation::devices
