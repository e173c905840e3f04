// SPDX-License-Identifier: Apache-2.0
// USB adapters of serial ports, as the kernel tells of them in /sys: which adapter a port belongs to whatever its
// number is now. Looks only; no port is opened.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace deltamap::drivers::port {

struct UsbAdapter {
  std::string kind;    ///< vendor, product, and which of an adapter's several ports: "0403:6001 1.0"
  std::string serial;  ///< empty where it has none
  std::string socket;  ///< where it is plugged in: "1-2"
  std::string name;    ///< for people: "FTDI FT232R USB UART"
  friend bool operator==(const UsbAdapter&, const UsbAdapter&) = default;
};

struct UsbPort {
  std::string path;  ///< "/dev/ttyUSB0"
  UsbAdapter adapter;
  /// "/dev/ttyUSB0 (FTDI FT232R USB UART, serial A50285BI, USB 1-2)"
  [[nodiscard]] std::string told() const;
};

/// Of the port at `path`, which may be a link; nothing where it is no USB adapter's, or is not there.
[[nodiscard]] std::optional<UsbAdapter> adapter_of(const std::filesystem::path& path,
                                                   const std::filesystem::path& sys = "/sys");

/// All ports of USB adapters that are plugged in, by name.
[[nodiscard]] std::vector<UsbPort> usb_ports(const std::filesystem::path& sys = "/sys");

/// Where an adapter is now: the one port with its serial number, wherever it is plugged in; without a serial number, or
/// where several have the same, the one in its socket. Nothing where there is no such port.
[[nodiscard]] std::optional<UsbPort> port_of(const UsbAdapter& adapter, const std::vector<UsbPort>& ports);

}  // namespace deltamap::drivers::port
