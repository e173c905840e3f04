// SPDX-License-Identifier: Apache-2.0
// What a serial port asks of the kernel's terminal layer: open and own the device, set the line, look at its queue.
#pragma once

#include <sys/types.h>

#include <string>

namespace deltamap::drivers::port {

/// Either an open descriptor (non-blocking, raw, owned by us alone), or one line with the reason.
struct OpenedTerminal {
  int descriptor = -1;
  std::string refused;
};
[[nodiscard]] OpenedTerminal open_terminal(const std::string& path, unsigned baud);

/// What follows a device's name in a refusal: the system's error, and what to do about it. A descriptor of this process
/// does not count among those that keep the device busy.
[[nodiscard]] std::string why_not_opened(const std::string& path, int error, int own_descriptor = -1);

/// By its device number: devices 136 to 143 are the slaves of pseudo-terminals (kernel's devices.txt).
[[nodiscard]] bool is_pseudo_terminal(dev_t number);

/// Gives the device free for others and closes it.
void close_terminal(int descriptor);

/// Empty where the line now runs at that speed, else why not.
[[nodiscard]] std::string set_line_speed(int descriptor, unsigned baud);

/// Bytes that were written and have not left the kernel's queue.
[[nodiscard]] int unsent_bytes(int descriptor);

void discard_unread_bytes(int descriptor);

}  // namespace deltamap::drivers::port
