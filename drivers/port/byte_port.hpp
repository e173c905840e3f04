// SPDX-License-Identifier: Apache-2.0
// A port that carries bytes to and from one device: what the io thread holds and what a session's PortRequests are done
// on. Everything happens on the one thread that runs the port's event loop.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <string>

#include "core/time.hpp"

namespace deltamap::drivers::port {

struct PortHandlers {
  /// A chunk as read() returned it, and when.
  std::function<void(std::span<const std::uint8_t> bytes, Timestamp stamp)> on_bytes;
  /// The device is gone or failed; told once, with the reason. Nothing comes after it; open a new port to try again.
  std::function<void(const std::string& reason)> on_closed;
};

class BytePort {
 public:
  BytePort() = default;
  virtual ~BytePort() = default;
  BytePort(const BytePort&) = delete;
  BytePort& operator=(const BytePort&) = delete;

  /// Begins to read. Handlers are called from the event loop, never from inside a call to this port; none is called
  /// after the port has been destroyed.
  virtual void start(PortHandlers handlers) = 0;

  /// Writes and changes of baud happen in the order of the calls; a change waits until what was written before it has
  /// left the machine. None of these blocks; a failure comes through on_closed.
  virtual void write(std::span<const std::uint8_t> bytes) = 0;
  virtual void set_baud(unsigned baud) = 0;
  /// Throws away what has arrived and was not handed over yet.
  virtual void discard_input() = 0;

  /// To be called by on_bytes: so many more bytes have to come before any is of use, so the port need not look for them
  /// one by one.
  virtual void await(std::size_t bytes) = 0;

  /// What the operator calls it: the device's path.
  [[nodiscard]] virtual const std::string& name() const = 0;
  /// The line speed as last asked for.
  [[nodiscard]] virtual unsigned baud() const = 0;
};

}  // namespace deltamap::drivers::port
