// SPDX-License-Identifier: Apache-2.0
// A serial device as a BytePort: 8N1, raw, no flow control, held exclusively, at low latency where the driver knows
// how. A pseudo-terminal serves as well, so that the simulator is reached through the same code.
#pragma once

#include <memory>
#include <string>

#include "drivers/port/byte_port.hpp"

namespace boost::asio {
class io_context;
}

namespace deltamap::drivers::port {

/// Either a port, or one line that names the device and why it cannot be used: missing, busy (by which process),
/// forbidden (and who may), not a serial port, a baud that it does not know.
struct SerialPortAnswer {
  std::unique_ptr<BytePort> port;
  std::string refused;
  std::string note{};  ///< where it is another port than the one of the settings: which, and why
};

/// Opens the device at `path`; nothing is read before start(). The port must not outlive the event loop.
[[nodiscard]] SerialPortAnswer open_serial_port(boost::asio::io_context& loop, const std::string& path, unsigned baud);

}  // namespace deltamap::drivers::port
