// SPDX-License-Identifier: Apache-2.0
// Looks at a serial port from outside, without opening it: no line is raised, no byte is read, whoever has it keeps it.
#pragma once

#include <cstdint>
#include <string>

namespace deltamap::drivers::port {

struct PortCheck {
  enum class State : std::uint8_t { kReady, kMissing, kNotSerial, kForbidden, kBusy } state = State::kReady;
  std::string text;  ///< one line that names the device
};

[[nodiscard]] PortCheck check_port(const std::string& path);

}  // namespace deltamap::drivers::port
